// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/error.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <iterator>
#include <random>
#include <stdexcept>
#include <string>
#include <typeinfo>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/lsan_interface.h>

/// The sanitizer's own memory has no bounds, so it limits the program's itself; what cannot be had is a
/// defect.
extern "C" inline const char *__asan_default_options()
{
  return "max_allocation_size_mb=2000:hard_rss_limit_mb=4000:allocator_may_return_null=0";
}
#endif

/// Reads damaged files by the hundred. A trial makes one damaged input and reads it. It may accept it, and
/// must then find sane contents, or refuse it with retroforge::Error. All else is a defect: other exceptions,
/// crashes, more than 10 s, more than 2 GB of memory, messages that lack a part or are no legible line.
///
/// Trials run in a forked child, so that a crash is told by its number and the others still run. Trial n of
/// seed s always does the same. The environment chooses:
///   FUZZ_TRIALS  number of trials of each kind (default 200)
///   FUZZ_SEED    (default 1)
///   FUZZ_ONLY    run this trial alone and without a fork, to look at it in a debugger
///   FUZZ_SHOW    tell what every trial ends with
namespace fuzz
{
  /// The same numbers everywhere; the distributions of the standard library are not.
  class Random
  {
  public:
    Random(const unsigned int seed, const unsigned int trial)
    {
      std::seed_seq sequence{seed, trial};
      engine_.seed(sequence);
    }

    /// From 0 to n - 1.
    std::size_t below(const std::size_t n) { return n == 0 ? 0 : engine_() % n; }

    template <typename Container>
    const auto &one_of(const Container &choices)
    {
      return *std::next(std::begin(choices), below(std::size(choices)));
    }

  private:
    std::mt19937_64 engine_;
  };

  /// A file was accepted whose contents no run could use.
  struct NotSane : std::runtime_error
  {
    using std::runtime_error::runtime_error;
  };

  inline void require(const bool condition, const std::string &what)
  {
    if (!condition)
      throw NotSane("accepted, but " + what);
  }

  using Trial = std::function<void(Random &)>;

  enum class Outcome : char
  {
    accepted = 'a',
    refused  = 'r',
    defect   = 'd'
  };

  inline unsigned int setting(const char *name, const unsigned int otherwise)
  {
    const char *text = std::getenv(name);
    return text == nullptr ? otherwise : std::strtoul(text, nullptr, 10);
  }

  /// What is wrong with a message `where: what; rule; remedy`; nothing if empty.
  inline std::string fault_of(const std::string &message, const std::string &mention)
  {
    if (message.find(mention) == std::string::npos)
      return "the message does not name the file";
    if (std::any_of(
          message.begin(), message.end(), [](const unsigned char c) { return c < ' ' || c == 127; }))
      return "the message holds control characters";
    if (message.size() > 4000)
      return "the message has " + std::to_string(message.size()) + " characters";
    const std::size_t what = message.find(": "), rule = message.find("; ", what);
    if (what == std::string::npos || rule == std::string::npos || rule == what + 2 ||
        message.find("; ", rule + 2) == std::string::npos || message.find("; ;") != std::string::npos ||
        message.size() < 2 || message.substr(message.size() - 2) == "; ")
      return "the message lacks a part";
    return "";
  }

  class Runner
  {
  public:
    Runner(const std::string &kind, const std::string &mention, const Trial &trial)
        : kind_(kind), mention_(mention), trial_(trial)
    {
    }

    void run()
    {
      const auto start = std::chrono::steady_clock::now();
      if (std::getenv("FUZZ_ONLY") != nullptr)
        attempt(setting("FUZZ_ONLY", 0));
      else
        while (next_ < n_)
          run_child();
      const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
      if (std::getenv("FUZZ_TRIALS") != nullptr)
        std::cerr << kind_ << ": " << n_ << " trials in " << time.count() << " s, accepted "
                  << std::count(outcomes_.begin(), outcomes_.end(), 'a') << ", refused "
                  << std::count(outcomes_.begin(), outcomes_.end(), 'r') << ", slowest trial " << slowest_
                  << " s\n";
      std::cout << kind_ << ": defects " << std::count(outcomes_.begin(), outcomes_.end(), 'd')
                << ", some refused: " << (has('r') ? "yes" : "NO")
                << ", some accepted: " << (has('a') ? "yes" : "NO") << std::endl;
    }

  private:
    const std::string  kind_, mention_;
    const Trial        trial_;
    const unsigned int n_ = setting("FUZZ_TRIALS", 200), seed_ = setting("FUZZ_SEED", 1);
    unsigned int       next_ = 0;
    std::string        outcomes_;
    double             slowest_ = 0.;

    bool has(const char outcome) const { return outcomes_.find(outcome) != std::string::npos; }

    Outcome defect(const unsigned int number, const std::string &what) const
    {
      std::cerr << kind_ << ", FUZZ_SEED=" << seed_ << " FUZZ_ONLY=" << number << ": " << what << std::endl;
      return Outcome::defect;
    }

    Outcome attempt(const unsigned int number) const
    {
      const bool shown = std::getenv("FUZZ_SHOW") != nullptr || std::getenv("FUZZ_ONLY") != nullptr;
      try
      {
        Random random(seed_, number);
        trial_(random);
        if (shown)
          std::cerr << number << " accepted\n";
        return Outcome::accepted;
      }
      catch (const retroforge::Error &error)
      {
        if (shown)
          std::cerr << number << " " << error.what() << '\n';
        const std::string fault = fault_of(error.what(), mention_);
        return fault.empty() ? Outcome::refused : defect(number, fault + ": " + error.what());
      }
      catch (const NotSane &error)
      {
        return defect(number, error.what());
      }
      catch (const std::exception &error)
      {
        return defect(number, std::string("throws ") + typeid(error).name() + ": " + error.what());
      }
      catch (...)
      {
        return defect(number, "throws an unknown exception");
      }
    }

    /// Several trials to a child: what one leaves behind is part of the next one's test.
    [[noreturn]] void child(const int pipe) const
    {
#if !defined(__SANITIZE_ADDRESS__)
      const rlimit memory{rlim_t(1) << 31, rlim_t(1) << 31};
      setrlimit(RLIMIT_DATA, &memory);
#endif
      for (unsigned int i = next_; i < std::min(n_, next_ + 100); ++i)
      {
        alarm(10);
        const char outcome = static_cast<char>(attempt(i));
        if (write(pipe, &outcome, 1) != 1)
          _exit(1);
      }
      alarm(0);
#if defined(__SANITIZE_ADDRESS__)
      if (__lsan_do_recoverable_leak_check() != 0)
        _exit(2);
#endif
      _exit(0);
    }

    void run_child()
    {
      int pipe_ends[2];
      if (pipe(pipe_ends) != 0)
        throw std::runtime_error("no pipe");
      const unsigned int first = next_;
      const pid_t        id    = fork();
      if (id < 0)
        throw std::runtime_error("no fork");
      if (id == 0)
        child(pipe_ends[1]);
      close(pipe_ends[1]);
      char outcome;
      auto before = std::chrono::steady_clock::now();
      for (; read(pipe_ends[0], &outcome, 1) == 1; ++next_)
      {
        const auto now = std::chrono::steady_clock::now();
        slowest_       = std::max(slowest_, std::chrono::duration<double>(now - before).count());
        before         = now;
        outcomes_ += outcome;
      }
      close(pipe_ends[0]);
      int status = 0;
      waitpid(id, &status, 0);
      end_of_child(status, first);
    }

    void end_of_child(const int status, const unsigned int first)
    {
      if (status == 0)
        return;
      if (WIFEXITED(status) && WEXITSTATUS(status) == 2)
      {
        defect(first, "this or one of the trials up to " + std::to_string(next_ - 1) + " leaks memory");
        outcomes_.back() = 'd';
        return;
      }
      const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
      defect(next_,
             signal == SIGALRM ? "takes more than 10 s"
             : signal != 0     ? "crashes by signal " + std::to_string(signal)
                               : "ends the program with status " + std::to_string(WEXITSTATUS(status)));
      outcomes_ += 'd';
      ++next_;
    }
  };

  /// Runs the trials and prints one line that tells the defects; what they are goes to std::cerr, with times.
  /// @param mention  what every message must contain: the name of the damaged file
  inline void run(const std::string &kind, const std::string &mention, const Trial &trial)
  {
    Runner(kind, mention, trial).run();
  }

  inline void write_bytes(const std::string &file, const std::string &bytes)
  {
    std::ofstream(file, std::ios::binary) << bytes;
  }

  inline std::string bytes_of(const std::string &file)
  {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  }
} // namespace fuzz
