# SPDX-License-Identifier: BSL-1.0
# The man page from the program's own help: cmake -DPROGRAM=quadrant-gap -DVERSION=0.1.0 -DOUT=quadrant-gap.1 -P man_page.cmake
# So an option that the program has is an option that the page has.
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
string(REGEX REPLACE ".*\nSubcommands:\n" "" subcommands "${plain}")
string(REGEX MATCHALL "(^|\n)  [a-z]+" subcommands "${subcommands}")
string(REGEX REPLACE "[\n ]" "" subcommands "${subcommands}")

help(text)
set(page ".TH QUADRANT-GAP 1 \"\" \"quadrant ${VERSION}\" \"User Commands\"
.SH NAME
quadrant-gap \\- why does the machine not do what its simulation says?
.SH SYNOPSIS
.B quadrant-gap
.I SUBCOMMAND
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
string(APPEND page ".SH EXIT STATUS
0 when what was asked for is written, 2 on bad input: one line on standard error with file, line and column or key.
.SH EXAMPLES
.nf
quadrant\\-gap init \\-\\-out machine.json \\-\\-log log.csv \\-\\-mass 340 \\-\\-force\\-constant 1450
quadrant\\-gap diagnose \\-\\-machine machine.json \\-\\-log log.csv \\-\\-json found.json \\-\\-report found.html
quadrant\\-gap apply \\-\\-machine machine.json \\-\\-diagnosis found.json \\-\\-out better.json
quadrant\\-gap simulate \\-\\-machine better.json \\-\\-log another.csv
quadrant\\-gap import \\-\\-map twincat_scope.map.json scope.csv log.csv
.fi
.SH SEE ALSO
docs/diagnosis.md and docs/formats.md of the project.
")
file(WRITE "${OUT}" "${page}")
