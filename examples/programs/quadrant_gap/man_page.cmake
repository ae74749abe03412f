# SPDX-License-Identifier: BSL-1.0
# The man page from the program's own help, so an option that the program has is an option that the page has:
#   cmake -DPROGRAM=FILE -DNAME=quadrant-gap "-DSUMMARY=why ..." -DVERSION=0.1.0 -DMORE=SECTIONS -DOUT=quadrant-gap.1 -P man_page.cmake
function(help out)
    execute_process(COMMAND "${PROGRAM}" ${ARGN} --help OUTPUT_VARIABLE text RESULT_VARIABLE code)
    if(code)
        message(FATAL_ERROR "${PROGRAM} ${ARGN} --help: exit code ${code}")
    endif()
    string(REPLACE "\\" "\\e" text "${text}")
    string(REPLACE "-" "\\-" text "${text}")
    string(REGEX REPLACE "\n([.'])" "\n\\\\&\\1" text "${text}")
    set(${out} "${text}" PARENT_SCOPE)
endfunction()

execute_process(COMMAND "${PROGRAM}" --help OUTPUT_VARIABLE plain)
set(subcommands)
if(plain MATCHES "\nSubcommands:\n(.*)")
    set(subcommands "${CMAKE_MATCH_1}")
endif()
string(REGEX MATCHALL "(^|\n)  [a-z]+" subcommands "${subcommands}")
string(REGEX REPLACE "[\n ]" "" subcommands "${subcommands}")

help(text)
string(TOUPPER ${NAME} title)
string(REPLACE "-" "\\-" name "${NAME}")
set(page ".TH ${title} 1 \"\" \"quadrant ${VERSION}\" \"User Commands\"
.SH NAME
${name} \\- ${SUMMARY}
.SH SYNOPSIS
.B ${name}
.RI [ OPTIONS ]
.SH OVERVIEW
.nf
${text}.fi
")
foreach(subcommand IN LISTS subcommands)
    help(text ${subcommand})
    string(TOUPPER ${subcommand} title)
    string(APPEND page ".SH ${title}\n.nf\n${text}.fi\n")
endforeach()
if(EXISTS "${MORE}")
    file(READ "${MORE}" more)
    string(REPLACE "-" "\\-" more "${more}")
    string(APPEND page "${more}")
endif()
file(WRITE "${OUT}" "${page}")
