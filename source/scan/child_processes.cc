// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/scan/child_processes.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <map>
#include <spawn.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

extern char **environ;

namespace retroforge
{
  namespace
  {
    using Clock = std::chrono::steady_clock;

    volatile std::sig_atomic_t caught_signal = 0;

    /// While it lives, signals that would end the program are only noted; those it ignores stay ignored.
    class SignalWatch
    {
    public:
      SignalWatch()
      {
        caught_signal         = 0;
        struct sigaction note = {};
        note.sa_handler       = [](const int signal) { caught_signal = signal; };
        sigemptyset(&note.sa_mask);
        for (unsigned int i = 0; i < n_watched; ++i)
        {
          sigaction(watched[i], nullptr, &before_[i]);
          if (before_[i].sa_handler != SIG_IGN)
            sigaction(watched[i], &note, nullptr);
        }
      }

      ~SignalWatch()
      {
        for (unsigned int i = 0; i < n_watched; ++i)
          sigaction(watched[i], &before_[i], nullptr);
      }

    private:
      static constexpr unsigned int n_watched          = 3;
      static constexpr int          watched[n_watched] = {SIGINT, SIGTERM, SIGHUP};
      struct sigaction              before_[n_watched];
    };

    std::vector<char *> pointers(const std::vector<std::string> &words)
    {
      std::vector<char *> result;
      for (const std::string &word : words)
        result.push_back(const_cast<char *>(word.c_str()));
      result.push_back(nullptr);
      return result;
    }

    pid_t start(const ChildProcess &process, const std::vector<std::string> &environment)
    {
      posix_spawn_file_actions_t files;
      posix_spawn_file_actions_init(&files);
      posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
      posix_spawn_file_actions_addopen(
        &files, STDOUT_FILENO, process.log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
      posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
      pid_t     child = 0;
      const int error = posix_spawn(&child,
                                    process.command[0].c_str(),
                                    &files,
                                    nullptr,
                                    pointers(process.command).data(),
                                    pointers(environment).data());
      posix_spawn_file_actions_destroy(&files);
      if (error != 0)
        throw Error(process.command[0],
                    std::string("cannot be started: ") + std::strerror(error),
                    "a scan runs the program once for each point",
                    "check that the program and the folder " + process.log + " is in are there");
      return child;
    }

    /// The children that run now.
    class Running
    {
    public:
      ~Running()
      {
        for (const auto &[child, ignored] : of_)
          kill(child, SIGTERM);
        for (const auto &[child, ignored] : of_)
          while (waitpid(child, nullptr, 0) < 0 && errno == EINTR)
            ;
      }

      std::size_t size() const { return of_.size(); }

      void add(const pid_t child, const std::size_t index) { of_[child] = {index, Clock::now()}; }

      /// One that has ended, if any.
      bool take_ended(std::size_t &index, ExitStatus &end)
      {
        for (auto entry = of_.begin(); entry != of_.end(); ++entry)
        {
          int         state = 0;
          const pid_t ended = waitpid(entry->first, &state, WNOHANG);
          if (ended == 0 || (ended < 0 && errno == EINTR))
            continue;
          index       = entry->second.first;
          end.seconds = std::chrono::duration<double>(Clock::now() - entry->second.second).count();
          end.signal  = ended > 0 && WIFSIGNALED(state) ? WTERMSIG(state) : 0;
          end.status  = ended > 0 && WIFEXITED(state) ? WEXITSTATUS(state) : 1;
          of_.erase(entry);
          return true;
        }
        return false;
      }

    private:
      std::map<pid_t, std::pair<std::size_t, Clock::time_point>> of_;
    };
  } // namespace

  std::vector<std::string> environment_now()
  {
    std::vector<std::string> environment;
    for (char **entry = environ; *entry != nullptr; ++entry)
      environment.emplace_back(*entry);
    return environment;
  }

  void run_side_by_side(const std::vector<ChildProcess>                            &processes,
                        const std::vector<std::string>                             &environment,
                        const unsigned int                                          at_a_time,
                        const std::function<void(std::size_t, const ExitStatus &)> &finished)
  {
    {
      const SignalWatch watch;
      Running           running;
      for (std::size_t next = 0; caught_signal == 0 && (next < processes.size() || running.size() > 0);)
      {
        std::size_t index;
        ExitStatus  end;
        if (running.take_ended(index, end))
        {
          if (caught_signal == 0)
            finished(index, end);
        }
        else if (next < processes.size() && running.size() < at_a_time)
        {
          running.add(start(processes[next], environment), next);
          ++next;
        }
        else
          std::this_thread::sleep_for(std::chrono::milliseconds(10));
      }
    }
    if (caught_signal != 0)
    {
      std::raise(caught_signal); // as if it had come now, the children being gone
      throw Error("scan", "was interrupted", "its runs end with it", "go on with --resume");
    }
  }
} // namespace retroforge
