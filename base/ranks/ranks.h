// SPDX-License-Identifier: Apache-2.0
// Ranks: processes on one or more machines that run the same call and share its long loops. Without
// ranks such a loop is a parallel loop of this process.
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

// Interface to the message passing library. All ranks make the same calls in the same order.
class Ranks {
 public:
  Ranks() = default;
  virtual ~Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  [[nodiscard]] virtual int number() const = 0;  // of this process, from 0
  [[nodiscard]] virtual int count() const = 0;
  // Ranks on this machine, including this one; they share its memory.
  [[nodiscard]] virtual int count_here() const = 0;
  [[nodiscard]] virtual bool first_is_here() const = 0;  // rank 0 is on this machine
  // Copies `bytes` bytes from rank `from` to all ranks.
  virtual void broadcast(void* first, std::size_t bytes, int from) = 0;
  // Sends to one rank without waiting. Any thread may send. Messages from one rank to another
  // arrive in order.
  virtual void send(std::string bytes, int to) = 0;
  [[nodiscard]] virtual std::string receive(int from) = 0;
  // All-gather. Before, rank r has the items [start[r], start[r + 1]), each of `bytes_each` bytes;
  // afterwards every rank has all items.
  virtual void all_gather(void* items, std::size_t bytes_each,
                          const std::vector<std::size_t>& start) = 0;
  // Gather: only rank 0 gets all items. On other ranks `items` points to their own ones.
  virtual void gather(void* items, std::size_t bytes_each,
                      const std::vector<std::size_t>& start) = 0;
  // Scatter: rank 0 has all items. Afterwards every rank has its own ones, at the start of `items`
  // on the others.
  virtual void scatter(void* items, std::size_t bytes_each,
                       const std::vector<std::size_t>& start) = 0;
  // Number of a loop item that no rank has taken yet, from 0; any thread may call it. After the
  // last item the numbers continue.
  [[nodiscard]] virtual std::size_t take() = 0;
  // Separates two loops that call take(). Each rank calls it after its last take() and after it has
  // received data from all ranks.
  virtual void end_of_taking() = 0;
  // Ends all ranks with this exit code.
  [[noreturn]] virtual void end_all(int exit_code) = 0;
};

// The installed ranks; nullptr: this process is the only one.
[[nodiscard]] Ranks* ranks();

// RAII: installs `ranks` for the current scope.
class RanksInForce {
 public:
  explicit RanksInForce(Ranks* ranks);
  ~RanksInForce();
  RanksInForce(const RanksInForce&) = delete;
  RanksInForce& operator=(const RanksInForce&) = delete;

 private:
  Ranks* before_;
};

// Serialised values between ranks of one program. pass() appends values to the bytes or extracts
// them, in the same order.
class Parcel {
 public:
  Parcel() = default;  // for writing
  explicit Parcel(std::string bytes) : bytes_(std::move(bytes)), fills_(false) {}

  template <class Value>
  void pass(Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    pass_bytes(&value, sizeof value);
  }
  // Both sides must give the same count.
  template <class Value>
  void pass_range(Value* first, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<Value>);
    pass_bytes(first, count * sizeof(Value));
  }
  // Also passes the size.
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

// All-gather of byte strings: each rank in turn broadcasts say(), and all ranks, including the
// sender, call take(). A rank needs memory for one message only.
void sequential_broadcast(Ranks& ranks, const std::function<std::string()>& say,
                          const std::function<void(int rank, std::string bytes)>& take);

// All-to-all: to[r] goes to rank r. Returns the strings from all ranks for this one.
[[nodiscard]] std::vector<std::string> swap(Ranks& ranks, std::vector<std::string> to);

// Barrier.
void meet(Ranks& ranks);

// Ranks that receive all results of a shared loop. The others have their own results only.
enum class Receivers { All, Root };

// Calls work(k) for every k in [0, count) in parallel. Ranks take items dynamically; suited to
// items of a millisecond or more. transfer(k) must pass all results of work(k): afterwards all
// ranks, or rank 0, have them. With a single item every rank computes it without communication.
// Calls within a parallel loop must have one item.
void share_loop(std::size_t count, const std::function<void(std::size_t k)>& work,
                const std::function<void(std::size_t k, Parcel& parcel)>& transfer,
                Receivers receivers = Receivers::All);

// The same for body(begin, end) over chunks of [0, count), assigned cyclically. For cheap items.
void share_chunks(
    std::size_t count, std::size_t chunk,
    const std::function<void(std::size_t begin, std::size_t end)>& body,
    const std::function<void(std::size_t begin, std::size_t end, Parcel& parcel)>& transfer,
    Receivers receivers = Receivers::All);

// Logical AND over all ranks.
[[nodiscard]] bool holds_on_all_ranks(bool here);

}  // namespace earthshine::base
