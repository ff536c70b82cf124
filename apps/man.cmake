# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause

# A manual page of what a program says with --help, so that there is one text of its use:
#     cmake -DPROGRAM=FILE -DVERSION=0.2.0 -DPAGE=gearsim.1 -P man.cmake
# A program that does not run here, for another machine or without its packages, gets none.
get_filename_component(NAME "${PAGE}" NAME_WE)
set(ENV{COLUMNS} 80)
execute_process(COMMAND "${PROGRAM}" --help OUTPUT_VARIABLE help ERROR_QUIET RESULT_VARIABLE failed)
if(failed OR help STREQUAL "")
  message(STATUS "${NAME}: --help does not run here, so there is no manual page")
  file(REMOVE "${PAGE}")
  return()
endif()

# What troff takes for its own: backslashes, hyphens, and lines that begin with a dot or an apostrophe.
string(REPLACE "\\" "\\e" help "${help}")
string(REPLACE "-" "\\-" help "${help}")
string(REGEX REPLACE "(^|\n)([.'])" "\\1\\\\&\\2" help "${help}")

# The usage is all up to the first empty line.
string(FIND "${help}" "\n\n" end)
string(SUBSTRING "${help}" 0 ${end} usage)
math(EXPR end "${end} + 2")
string(SUBSTRING "${help}" ${end} -1 text)
string(REGEX REPLACE "^usage: " "" usage "${usage}")
string(REGEX REPLACE "\n       " "\n" usage "${usage}")

# The first line of the text says what it is.
string(FIND "${text}" "\n" end)
string(SUBSTRING "${text}" 0 ${end} what)
string(REGEX REPLACE "\\.$" "" what "${what}")

string(TOUPPER "${NAME}" title)
file(WRITE "${PAGE}" ".TH ${title} 1 \"\" \"gearmesh ${VERSION}\" \"gearmesh\"
.SH NAME
${NAME} \\- ${what}
.SH SYNOPSIS
.nf
${usage}
.fi
.SH DESCRIPTION
.nf
${text}.fi
")
