# SPDX-License-Identifier: BSL-1.0
# What Doxygen reads instead of a header: the same lines, the text of /// kept as it was written. An indented line (an equation,
# a line of code) becomes verbatim, a labelled one (Cost: ...) a paragraph, and no |x|, a*b or <n> is taken for markup.
# Doxygen itself leaves alone what stands between quotes or backticks. A comment above `namespace quadrant` is the header's.
# The members that every block has (a class whose comment says Ports:) mean the same everywhere; where they say nothing of
# their own, that stands there.
function plain(text,    out, mark, part) {
    while (match(text, /["`]/)) {
        mark = substr(text, RSTART, 1)
        part = substr(text, 1, RSTART - 1)
        out = out (within ? part : escaped(part)) mark
        if (!within) within = mark
        else if (within == mark) within = ""
        text = substr(text, RSTART + 1)
    }
    return out (within ? text : escaped(text))
}
function escaped(text) {
    gsub(/[*_[<>&#%@|~$\\]/, "\\\\&", text)
    gsub(/ch\. /, "ch.\\ ", text) # no end of a sentence
    gsub(/eq\. /, "eq.\\ ", text)
    return text
}
function convention(line) {
    if (line ~ / operator\(\)\(/) return "One sample; see Ports."
    if (line ~ /^ *void reset\(\)/) return "As new; see State."
    if (line ~ /^ *void settle\(/) return "The state that belongs to these values, without a step; clears the fault. See State."
    if (line ~ /^ *void shift\(/) return "The frame of positions moves by so much: no step of the output but that."
    if (line ~ /^ *void retune\(/) return "Goes on with the parameters of another block of its kind; the jump is bounded as the class says."
    if (line ~ / faulted\(\) const/) return "A value that was not finite came since the last reset or settle."
    if (line ~ / limited\(\) const/) return "What was asked for last was beyond a bound, and was cut to it."
    if (line ~ / given\(\) const/) return "The parameters that it runs with."
    if (line ~ / state&? now\(\) const/) return "The state after the last step."
    if (line ~ /complex<double> response\(frequency f\) const/) return "From input to output at f, as the block runs it."
    if (line ~ /^ *[a-z_]+\(const parameters&.*, duration period\)/) return "Checks the parameters and derives what a step needs."
    if (line ~ /^ *using input = /) return "The signal that comes in."
    if (line ~ /^ *using output = /) return "The signal that goes out."
    if (line ~ /^ *using argument = /) return "What comes in, a number with its unit."
    if (line ~ /^ *using value = /) return "What goes out, a number with its unit."
    return ""
}
function flush(next_line,    i) {
    if (/^};/) block_of_ports = 0
    if (lines && before == "" && next_line ~ /^(namespace quadrant|#include)/) before = "/// \\file"
    if (NR > 1) print before
    for (i = 1; i <= lines; ++i) {
        print block[i]
        if (block[i] ~ /^\/\/\/.* Ports: /) block_of_ports = 1
    }
    bare = block_of_ports && !lines
    lines = 0
}
# The inline version namespace is nobody's to write: the pages show quadrant::notch.
/^(} \/\/ )?namespace quadrant::inline v[0-9]/ { sub(/::inline v[0-9]+/, "") }
/^ *\/\/\/([^<]|$)/ {
    at = index($0, "///") + 3
    code = substr($0, 1, at - 1)
    text = substr($0, at)
    if (text ~ /^   /)
        text = " \\verbatim" text " \\endverbatim"
    else
        text = plain(text)
    if (text ~ /^ (Throws |(Cost|Derivation|Limits|NaN|Ports|Range|Signs|Source|State|Threads|Time|Units)[^.]*: )/)
        code = code " <p>"
    block[++lines] = code text
    next
}
{
    flush($0)
    within = ""
    at = index($0, "///<")
    if (bare && !at && /^    [^ ]/ && (said = convention($0)) != "") sub(/^ */, "&/** " said " */ ")
    before = at ? substr($0, 1, at + 3) plain(substr($0, at + 4)) : $0
}
END { flush("") }
