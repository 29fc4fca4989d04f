// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// Runs the program many times: loading its libraries and starting MPI, half a second, are done once, and each
// run is a fork of that. It reads lines
//     FOLDER 0x1f FILE FOR OUTPUT 0x1f FILE FOR ERRORS 0x1f ARGUMENT 0x1f ARGUMENT ...
// and answers each with the number of the process that runs there, and when that has ended with `exit STATUS`
// or `signal NUMBER`. Usage: fork_server BYTES, the memory that a run may ask for
#include <retroforge/app/program.h>
#include <retroforge/scan/scan.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace
{
  void redirect(const std::string &file, const int flags, const int descriptor)
  {
    const int opened = open(file.c_str(), flags, 0644);
    if (opened < 0 || dup2(opened, descriptor) < 0)
      std::_Exit(99);
    close(opened);
  }

  void limit(const int resource, const rlim_t most)
  {
    const rlimit limits = {most, most};
    setrlimit(resource, &limits);
  }

  [[noreturn]] void run(std::vector<std::string> words, const rlim_t memory)
  {
    if (chdir(words[0].c_str()) != 0)
      std::_Exit(99);
    redirect("/dev/null", O_RDONLY, 0);
    redirect(words[1], O_WRONLY | O_CREAT | O_TRUNC, 1);
    redirect(words[2], O_WRONLY | O_CREAT | O_TRUNC, 2);
    limit(RLIMIT_AS, memory);
    limit(RLIMIT_CORE, 0);
    std::vector<char *> arguments;
    words[2] = "retroforge";
    for (std::size_t i = 2; i < words.size(); ++i)
      arguments.push_back(words[i].data());
    arguments.push_back(nullptr);
    const int status =
      retroforge::run_program(arguments.size() - 1, arguments.data(), retroforge::environment_now());
    std::cout.flush();
    std::cerr.flush();
    std::fflush(nullptr);
    std::_Exit(status); // MPI is ended by the process that started it
  }
} // namespace

int main(int argc, char **argv)
{
  if (argc != 2)
    return 2;
  const rlim_t                             memory = std::strtoull(argv[1], nullptr, 10);
  int                                      one    = 1;
  dealii::Utilities::MPI::MPI_InitFinalize mpi(one, argv, 1);
  for (std::string line; std::getline(std::cin, line);)
  {
    std::vector<std::string> words;
    std::istringstream       stream(line);
    for (std::string word; std::getline(stream, word, '\x1f');)
      words.push_back(word);
    if (words.size() < 4)
      return 2;
    const pid_t process = fork();
    if (process < 0)
      return 3;
    if (process == 0)
      run(words, memory);
    std::cout << process << std::endl;
    int status = 0;
    waitpid(process, &status, 0);
    if (WIFEXITED(status))
      std::cout << "exit " << WEXITSTATUS(status) << std::endl;
    else
      std::cout << "signal " << WTERMSIG(status) << std::endl;
  }
  return 0;
}
