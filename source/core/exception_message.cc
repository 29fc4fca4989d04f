// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/exceptions.h>

#include <retroforge/core/error.h>
#include <retroforge/core/exception_message.h>

#include <ios>
#include <new>
#include <sstream>

namespace retroforge
{
  namespace
  {
    Error unexpected(const std::string &library, const std::string &what)
    {
      return Error(library,
                   what,
                   "this should not happen, whatever the input",
                   "if values are far from the usual (lengths in mm, speeds in mm/s, stresses in MPa), "
                   "correct them, else please report it with the case file");
    }

    /// Its explanation without the stack and the place in the library.
    std::string explanation(const dealii::ExceptionBase &failure)
    {
      std::ostringstream text, words;
      failure.print_info(text);
      std::istringstream in(text.str());
      for (std::string word; in >> word;)
        words << (words.tellp() > 0 ? " " : "") << word;
      return words.str();
    }
  } // namespace

  std::string message_of(const std::exception_ptr &exception)
  {
    try
    {
      std::rethrow_exception(exception);
    }
    catch (const Error &error)
    {
      return error.what();
    }
    catch (const std::bad_alloc &)
    {
      return Error("memory",
                   "there is not enough of it",
                   "mesh, matrices and, without Output/record, all increments must fit",
                   "use a coarser mesh, a larger chord error of the dies, or a machine with more memory")
        .what();
    }
    catch (const dealii::ExceptionBase &failure)
    {
      return unexpected("deal.II", explanation(failure)).what();
    }
    catch (const std::exception &failure)
    {
      return unexpected("a library", failure.what()).what();
    }
    catch (const int status) // as Trilinos throws it
    {
      return unexpected("Trilinos", "ended with status " + std::to_string(status)).what();
    }
    catch (...)
    {
      return unexpected("a library", "ended without a reason").what();
    }
  }
} // namespace retroforge
