// SPDX-License-Identifier: Apache-2.0
// Parses the command line, runs one command, and converts errors to one line and an exit code: 0
// success, 1 the work failed, 2 the call or the scene is wrong, 3 done in part (StoppedShort).
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <sstream>
#include <thread>

#include "app/command.h"
#include "app/console.h"
#include "app/help.h"
#include "app/options.h"
#include "base/error.h"
#include "base/files/output_file.h"
#include "base/free_memory.h"
#include "base/parallel.h"
#include "base/ranks/start.h"

// jemalloc's configuration at start. Pictures repeatedly allocate and free a few values per pixel:
// their pages are kept until base/free_memory.h releases them.
extern "C" {
extern const char* malloc_conf;
const char* malloc_conf = "dirty_decay_ms:-1";
}

namespace earthshine::app {
namespace {

constexpr int work_failed = 1;
constexpr int call_is_wrong = 2;
constexpr int stopped_short = 3;
constexpr std::uint64_t most_threads = 4096;

void add_common_options(CLI::App& parser, Common& common, std::uint64_t& threads) {
  add_whole_number(parser, "-j,--threads", threads, 0, most_threads, "Threads; 0 means all cores");
  add_whole_number(parser, "--seed", common.seed, 0, ~std::uint64_t{0},
                   "Seed of the random numbers (default 1)");
  add_memory_option(parser, common.max_memory_bytes);
  parser.add_flag("-q,--quiet", common.quiet, "No progress, no notes on standard error");
}

int usage_error(const CLI::App& program, const CLI::ParseError& error) {
  const std::string words = words_to(chosen_parser(program));
  const std::string where = words.empty() ? "" : words.substr(0, words.size() - 1) + ": ";
  note(fmt::format("earthshine: {}{}", where, problem_of(program, error)));
  note(fmt::format("\"earthshine {}--help\" shows how to call it.", words));
  return call_is_wrong;
}

// Processes of a call. ranks: share its loops; nullptr: this process alone. processes: number on
// this machine that share its memory. whole: the user's call, not a part of it made by
// study_in_ranks().
struct Workers {
  base::Ranks* ranks = nullptr;
  int processes = 1;
  bool whole = false;
};
int run(std::vector<std::string> arguments, const Workers& workers);

// Ranks of a study share the loops of its solution, then its points/ as with --part. The first rank
// reports.
int study_in_ranks(const std::vector<std::string>& arguments, base::Ranks& ranks) {
  const auto task = [&](const std::string& part, const Workers& workers) {
    std::vector<std::string> call = arguments;
    if (part != "merge") std::erase(call, "--json");  // only the merge has a report
    call.insert(call.end(), {"--part", part});
    return run(std::move(call), workers);
  };
  const bool speaks = ranks.number() == 0;
  const bool plans = std::find(arguments.begin(), arguments.end(), "--dry-run") != arguments.end();
  if (plans) return speaks ? run(arguments, {}) : 0;
  int code = task("begin", {&ranks, ranks.count_here()});
  base::meet(ranks);
  const std::string share = fmt::format("{}/{}", ranks.number() + 1, ranks.count());
  code = std::max(code, task(share, {nullptr, ranks.count_here()}));
  base::meet(ranks);
  return speaks ? std::max(code, task("merge", {})) : code;
}

// Rejects calls that ranks cannot share. True for studies, which also share points.
bool is_study_of_ranks(const CLI::App& program, const std::vector<std::string>& arguments) {
  bool solves = false;  // the solution only
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    const std::string& word = arguments[k];
    const bool part = word.starts_with("--part");
    if (!part && !word.starts_with("--time-limit")) continue;
    solves = part && (word == "--part=solve" || (k + 1 < arguments.size() && word == "--part" &&
                                                 arguments[k + 1] == "solve"));
    if (solves) continue;
    throw base::Error(base::Blame::Input, word, "does not go with ranks of mpirun",
                      "but for --part solve, the solution that all parts read",
                      "Leave it out, or mpirun");
  }
  const std::string words = words_to(chosen_parser(program));
  for (const char* known : {"study run ", "study orbit ", "study visibility ", "study accuracy "}) {
    if (words == known) return !solves;
  }
  if (words == "render " || words == "solve ") return false;
  throw base::Error(base::Blame::Input, words, "is the work of one process",
                    "ranks share out render, solve and study run, orbit, visibility and accuracy",
                    "Leave out mpirun");
}

int run(std::vector<std::string> arguments, const Workers& workers) {
  CLI::App program(
      "Earthshine: light in a spacecraft's payload bay. Radiosity, final gather and the CCTV "
      "camera.",
      "earthshine");
  program.set_version_flag("--version", "earthshine " EARTHSHINE_VERSION);
  program.require_subcommand(1);
  program.formatter(std::make_shared<Help>());
  Common common;
  common.arguments = arguments;
  std::uint64_t threads = 0;
  std::vector<Command> commands = {
      add_render(program),  add_solve(program), add_form_factors(program), add_plan(program),
      add_inspect(program), add_new(program),   add_relight(program)};
  for (Command& part : add_degrade(program)) commands.push_back(std::move(part));
  commands.push_back(add_fit_phong(program));
  for (Command& part : add_study(program)) commands.push_back(std::move(part));
  commands.push_back(add_report(program));
  commands.push_back(add_console(program));
  commands.push_back(add_dataset(program));
  commands.push_back(add_view(program));
  commands.push_back(add_manual(program));
  commands.push_back(add_completion(program));
  int exit_code = 0;
  commands.push_back(add_merge(
      program, [&exit_code](const std::vector<std::string>& call) { exit_code = run(call, {}); }));
  add_common_options(program, common, threads);
  for (const Command& command : commands) add_common_options(*command.parser, common, threads);
  try {
    std::reverse(arguments.begin(), arguments.end());  // the order that CLI11 expects
    program.parse(arguments);
    refuse_empty_words(program);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) return usage_error(program, error);
    std::ostringstream text, ignored;
    program.exit(error, text, ignored);  // --help, --version
    print(text.str());
    return 0;
  }
  base::Ranks* const ranks = workers.ranks;
  if (workers.whole && ranks != nullptr) {
    const base::RanksInForce all(ranks);
    check_ranks_alike(Json::object({{"--part", part_in(common.arguments)}}));
  }
  if (workers.whole && ranks != nullptr && is_study_of_ranks(program, common.arguments)) {
    return study_in_ranks(common.arguments, *ranks);
  }
  common.threads = static_cast<int>(threads);
  const base::ThreadLimit limit(common.threads);
  common.progress = std::make_shared<Progress>(common.quiet);
  const base::MemoryLimit memory(common.max_memory_bytes, workers.processes);
  const base::RanksInForce in_force(ranks);
  // A barrier too: no rank allocates memory before all have measured the free memory.
  check_ranks_alike(Json::object({{"the call", part_free(common.arguments)}}));
  (void)common.progress->begin("reading", Work::Read, 1.0);
  for (const Command& command : commands) {
    if (command.parser->parsed() && command.run) command.run(common);
  }
  return exit_code;
}

// The rank that fails reports why, and ends all ranks including itself.
volatile std::sig_atomic_t is_rank = 0;

// Interrupted or terminated: removes unfinished files, and the shell sees the signal.
void end_by_signal(int signal) {
  base::remove_unfinished_files();
  if (is_rank == 0) {
    note_in_handler(Interrupt::asked()
                        ? "earthshine: interrupted again: ended without what was under way\n"
                        : "earthshine: interrupted: ended without what was under way\n");
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

// For exceptions where none are allowed: oneTBB at exit, if no thread can be created.
[[noreturn]] void end_by_exception() {
  base::remove_unfinished_files();
  const std::exception_ptr thrown = std::current_exception();
  try {
    if (thrown) std::rethrow_exception(thrown);
    std::fputs("earthshine: ended by a fault of a library\n", stderr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "earthshine: %s\n", error.what());  // note() might lack memory
  } catch (...) {
    std::fputs("earthshine: ended by a fault of a library\n", stderr);
  }
  std::_Exit(work_failed);
}

void take_signals() {
  std::signal(SIGPIPE, SIG_IGN);  // a closed pipe is reported by the write,
  std::signal(SIGXFSZ, SIG_IGN);  // and so is a file beyond `ulimit -f`
  std::set_terminate(end_by_exception);
  for (const int signal : ending_signals) {
    // Signals that the parent ignores stay ignored, as with nohup.
    if (std::signal(signal, end_by_signal) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

int complain(std::string_view what, int exit_code) {
  note(fmt::format("earthshine: {}", what));
  return exit_code;
}

// Time that other ranks wait after an error. All ranks find errors of the call: the first one
// reports them and ends the others meanwhile. Errors of one rank are reported by that rank.
constexpr std::chrono::seconds time_to_speak{3};

void end_rank(base::Ranks& ranks, int exit_code, const std::string& what) {
  if (ranks.number() > 0) {
    std::this_thread::sleep_for(time_to_speak);
    be_silent(false);
    note(fmt::format("earthshine: rank {} of {}: {}", ranks.number(), ranks.count(),
                     what.empty() ? "the call is wrong" : what));
  }
  ranks.end_all(exit_code);
}

}  // namespace
}  // namespace earthshine::app

int main(int argc, char** argv) {
  using namespace earthshine;
  std::unique_ptr<base::Ranks> ranks;
  std::string what;
  const auto failed = [&what](std::string_view why, int exit_code) {
    what = why;
    return app::complain(why, exit_code);
  };
  const auto run = [&] {
    try {
      ranks = base::start_ranks(argc, argv);
      app::is_rank = ranks ? 1 : 0;
      app::take_signals();
      app::be_silent(ranks && ranks->number() > 0);
      const int exit_code = app::run({argv + std::min(argc, 1), argv + argc},
                                     {ranks.get(), ranks ? ranks->count_here() : 1, true});
      return exit_code == 0 && app::lost_a_note() ? app::work_failed : exit_code;
    } catch (const base::Error& error) {
      const bool input = error.blame() == base::Blame::Input;
      return failed(error.what(), input ? app::call_is_wrong : app::work_failed);
    } catch (const app::StoppedShort& error) {
      return failed(error.what(), app::stopped_short);
    } catch (const std::bad_alloc&) {
      return failed(
          "out of memory; larger patches (quality.patch_edge) or a smaller picture need less",
          app::work_failed);
    } catch (const std::exception& error) {
      return failed(error.what(), app::work_failed);
    }
  };
  const int exit_code = run();
  const bool done = exit_code == 0 || exit_code == app::stopped_short;
  if (ranks && !done) app::end_rank(*ranks, exit_code, what);
  return exit_code;
}
