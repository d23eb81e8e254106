// SPDX-License-Identifier: Apache-2.0
// Ranks: processes on one machine or many that run the same call side by side and share out its
// heavy loops. Without any (the plain program) such a loop is a parallel one of this process.
#pragma once

#include <cstddef>
#include <cstring>
#include <functional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace earthshine::base {

// What connects them. All ranks make the same calls in the same order.
class Ranks {
 public:
  Ranks() = default;
  virtual ~Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  [[nodiscard]] virtual int number() const = 0;  // of this process, from 0
  [[nodiscard]] virtual int count() const = 0;
  // Of them those on this machine, this one included: they share its memory.
  [[nodiscard]] virtual int count_here() const = 0;
  [[nodiscard]] virtual bool first_is_here() const = 0;  // rank 0 is one of them
  // `bytes` bytes of rank `from`, on every rank.
  virtual void broadcast(void* first, std::size_t bytes, int from) = 0;
  // To one rank, without waiting for it; any thread may send. What one rank sends to another comes
  // there in that order.
  virtual void send(std::string bytes, int to) = 0;
  [[nodiscard]] virtual std::string receive(int from) = 0;
  // Of items of `bytes_each`, rank r has [start[r], start[r + 1]): afterwards every rank has all.
  virtual void gather(void* items, std::size_t bytes_each,
                      const std::vector<std::size_t>& start) = 0;
  // The same, but the first rank alone has all afterwards; elsewhere `items` are the own.
  virtual void gather_at_first(void* items, std::size_t bytes_each,
                               const std::vector<std::size_t>& start) = 0;
  // The other way round: the first rank has all, afterwards `items` are the own everywhere.
  virtual void scatter_from_first(void* items, std::size_t bytes_each,
                                  const std::vector<std::size_t>& start) = 0;
  // Of a loop's items, by number from 0, one that no rank has taken yet; from any thread. After the
  // last of them numbers go on.
  [[nodiscard]] virtual std::size_t take() = 0;
  // Between two loops that take(): every rank has taken, and heard all ranks since.
  virtual void end_of_taking() = 0;
  // Ends all of them at once with this exit code.
  [[noreturn]] virtual void end_all(int exit_code) = 0;
};

// Those in force; nullptr: this process is alone.
[[nodiscard]] Ranks* ranks();

// Puts them in force for as long as it lives.
class RanksInForce {
 public:
  explicit RanksInForce(Ranks* ranks);
  ~RanksInForce();
  RanksInForce(const RanksInForce&) = delete;
  RanksInForce& operator=(const RanksInForce&) = delete;

 private:
  Ranks* before_;
};

// Values on their way between ranks of the same program: pass() appends them to the bytes, or takes
// them from there, in the same order.
class Parcel {
 public:
  Parcel() = default;  // to be filled
  explicit Parcel(std::string bytes) : bytes_(std::move(bytes)), fills_(false) {}

  template <class Value>
  void pass(Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    pass_bytes(&value, sizeof value);
  }
  // As many as there are, on both sides.
  template <class Value>
  void pass_range(Value* first, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<Value>);
    pass_bytes(first, count * sizeof(Value));
  }
  // The size travels too.
  template <class Value>
  void pass(std::vector<Value>& values) {
    static_assert(std::is_trivially_copyable_v<Value>);
    std::size_t size = values.size();
    pass(size);
    values.resize(size);
    pass_bytes(values.data(), size * sizeof(Value));
  }
  void pass(std::string& text) {
    std::size_t size = text.size();
    pass(size);
    text.resize(size);
    pass_bytes(text.data(), size);
  }
  template <class... Values>
  void pass_all(Values&... values) {
    (pass(values), ...);
  }
  void reserve(std::size_t bytes) { bytes_.reserve(bytes); }
  [[nodiscard]] std::string take_bytes() { return std::move(bytes_); }
  [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }

 private:
  void pass_bytes(void* value, std::size_t size) {
    if (size == 0) return;
    if (fills_) {
      bytes_.append(static_cast<const char*>(value), size);
      return;
    }
    if (size > bytes_.size() - at_) throw std::length_error("a parcel between ranks is too short");
    std::memcpy(value, bytes_.data() + at_, size);
    at_ += size;
  }

  std::string bytes_;
  std::size_t at_ = 0;
  bool fills_ = true;
};

// Each rank in turn says something, and all of them, itself too, hear it: none needs room for more
// than one rank's.
void hear_all(Ranks& ranks, const std::function<std::string()>& say,
              const std::function<void(int rank, std::string bytes)>& hear);

// to[r] goes to rank r; returned is what each rank gave for this one.
[[nodiscard]] std::vector<std::string> swap(Ranks& ranks, std::vector<std::string> to);

// Returns once every rank has called it.
void meet(Ranks& ranks);

// Which rank has all that a shared loop has changed. The others have what they did themselves.
enum class Hears { All, First };

// work(k) for every k in [0, count), in parallel, each by the rank that comes to it first: for
// items of a millisecond or more. transfer(k) must pass all that work(k) changes, so that
// afterwards every rank has all of it, or the first. A single item is worked out by every rank,
// without a word: what is called from within a parallel loop must be so.
void share_loop(std::size_t count, const std::function<void(std::size_t k)>& work,
                const std::function<void(std::size_t k, Parcel& parcel)>& transfer,
                Hears hears = Hears::All);

// The same of body(begin, end) over [0, count) in chunks, dealt out in turn: for cheap ones.
void share_chunks(
    std::size_t count, std::size_t chunk,
    const std::function<void(std::size_t begin, std::size_t end)>& body,
    const std::function<void(std::size_t begin, std::size_t end, Parcel& parcel)>& transfer,
    Hears hears = Hears::All);

// Whether it holds on every rank.
[[nodiscard]] bool holds_on_all_ranks(bool here);

}  // namespace earthshine::base
