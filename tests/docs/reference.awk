# SPDX-License-Identifier: BSL-1.0
# What Doxygen reads instead of a header: the same lines, the text of /// kept as it was written. An indented line (an equation,
# a line of code) becomes verbatim, a labelled one (Cost: ...) a paragraph, and no |x|, a*b or <n> is taken for markup.
# Doxygen itself leaves alone what stands between quotes or backticks. A comment above `namespace quadrant` is the header's.
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
function flush(next_line,    i) {
    if (lines && before == "" && next_line ~ /^(namespace quadrant|#include)/) before = "/// \\file"
    if (NR > 1) print before
    for (i = 1; i <= lines; ++i) print block[i]
    lines = 0
}
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
    before = at ? substr($0, 1, at + 3) plain(substr($0, at + 4)) : $0
}
END { flush("") }
