#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: reference.sh OUT
#                             Doxygen's reference of every public entity, as OUT/html/index.html; any warning is an error, and so
#                             is a public struct, class, function, type, constant or concept that no comment explains. What stands in a
#                             namespace detail is not public; a literal's name is its unit; members are not asked for.
set -u
command -v doxygen >/dev/null || { echo 'SKIPPED: docs.reference: no doxygen (apt-get install doxygen)'; exit 77; }
mkdir -p "${1:?usage: reference.sh OUT}" && out=$(cd "$1" && pwd) || exit 1
cd "$(dirname "$0")/../.." || exit 1
rm -rf "$out/html"
{ cat docs/Doxyfile && printf 'OUTPUT_DIRECTORY = "%s"\n' "$out"; } | doxygen - || { echo "doxygen: exit code $?"; exit 1; }

# A second time over the headers, without pages: with EXTRACT_ALL, which makes the pages complete, Doxygen never misses a comment.
{ cat docs/Doxyfile && printf '%s\n' 'INPUT = include/quadrant' 'EXTRACT_ALL = NO' 'GENERATE_HTML = NO' 'WARN_AS_ERROR = NO' \
    'USE_MDFILE_AS_MAINPAGE =' "OUTPUT_DIRECTORY = \"$out\""; } | doxygen - 2>"$out/undocumented.txt" ||
    { echo "doxygen: exit code $?"; exit 1; }

failed=0
wrong() { echo "FAILED: $*"; failed=1; }
says() { # PAGE TEXT, as it stands in the comment
    [ -s "$out/html/$1" ] || { wrong "no page $1"; return; }
    sed 's/<[^>]*>//g; s/&lt;/</g; s/&gt;/>/g; s/&quot;/"/g; s/&amp;/\&/g' "$out/html/$1" | grep -qF -- "$2" || wrong "$1 does not say: $2"
}
says index.html 'it says why a machine does not do what its simulation predicts'
says classquadrant_1_1notch.html 'H(s) = (s^2 + w^2) / (s^2 + width w s + w^2), bilinear'
says classquadrant_1_1notch.html "jump = |b0' - b0| |x[k] - x[k-1]|"
says classquadrant_1_1notch.html 'The state that belongs to these values, without a step'
says structquadrant_1_1notch_1_1parameters.html 'deepest point; 0 < centre < half the sampling rate'
says conceptquadrant_1_1signal__tag.html 'signal_tag'
says structquadrant_1_1cascade__p__pi__boxes.html 'cascade<cascade_p_pi_boxes<>> axis{.box = {parameters, 500_us}};'
says namespacequadrant_1_1diagnosis.html 'From a machine file and a log to where they differ, why, how surely'
says namespacequadrant_1_1diagnosis.html 'Writes the causes of a diagnosis that are at least as probable as at_least into a machine file'
grep -q '<pre class="fragment">H(s) = ' "$out/html/classquadrant_1_1notch.html" || wrong 'the equation of notch is no line of its own'
grep -lE '^ *///' "$out"/html/*.html && wrong 'marks of comments in the text'
ls "$out/html" | grep -m 1 -E '_1_1detail(_1_1.*|-members)?\.html' && wrong 'pages of what is inside'
sed -n 's/^.*\(include\/quadrant\/.*\): warning: \(Compound\|Member\) \(.*\) is not documented\.$/\1: \2 \3/p' "$out/undocumented.txt" |
    grep -E ': Compound | of (namespace|file) ' | grep -v 'operator""' >"$out/missing.txt"
grep -q 'is not documented' "$out/undocumented.txt" || wrong 'no list of what is not documented'
[ ! -s "$out/missing.txt" ] || wrong "no comment on $(cat "$out/missing.txt")"
for page in "$out"/html/concept*_*.html; do
    grep -q 'Detailed Description' "$page" || wrong "no comment on ${page##*/}"
done
headers=$(find include/quadrant -name '*.hpp' | wc -l)
pages=$(find "$out/html" -name '*_8hpp.html' | wc -l)
[ "$headers" = "$pages" ] || wrong "$headers headers, $pages pages of them"
[ $failed = 0 ] && echo "$(find "$out/html" -name '*.html' | wc -l) pages of $headers headers: $out/html/index.html"
exit $failed
