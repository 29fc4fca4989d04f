# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Makes Doxygen's input from the pages of the repository.

pages      the Markdown pages, their links and their place among the contents
generated  pages that come from the program and from the news
"""
