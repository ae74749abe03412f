# SPDX-License-Identifier: BSL-1.0
# What program.sh and mpi.sh have in common: $program, $root, $scratch are set.
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"
fail() { echo "FAILED: $1"; exit 1; }
says() { grep -qF -- "$1" said.txt || fail "does not say '$1': $(cat said.txt)"; }
data=$root/examples/data

# A line of machines with one machine file, a press with its own, a log with a number missing, one without a machine file.
mkdir -p 'logs/line/a b' logs/alone
cp "$data/machine.json" logs/line/
part() { sed -n "1p;$1p" "$data/log.csv"; }
part '2,4201' >logs/line/1.log.csv
part '2,4601' >'logs/line/a b/log.csv'
part '2,4101' >'logs/line/a b/holdout.csv'
part '2,4401' >logs/press.log.csv
sed 's/"mass": 0.02/"mass": 0.03/' "$data/machine.json" >logs/press.machine.json
sed '77s/,[^,]*,/,nan,/' logs/press.log.csv >logs/line/broken.log.csv
cp logs/press.log.csv logs/alone/log.csv

same() { # RESULTS: those of diagnose, and nothing half done
    for name in 'line/1' 'line/a b' press; do
        for end in diagnosis.json html; do
            cmp "alone/$name.$end" "$1/$name.$end" || fail "$name.$end in $1 is not what diagnose writes"
        done
        [ -s "$1/$name.done.json" ] || fail "$1/$name.done.json is missing"
    done
    left=$(find "$1" -name '.working-*' -o -name '*.tmp*')
    [ -z "$left" ] || fail "left behind: $left"
    grep -q '</html>' "$1/fleet.html" || fail "no overview in $1"
}
diagnose() { # NAME MACHINE LOG [HOLDOUT]
    "$program" diagnose --quiet --threads 1 --machine "$2" --log "$3" ${4:+--holdout "$4"} --json "alone/$1.diagnosis.json" \
        --report "alone/$1.html"
}
mkdir -p alone/line
diagnose line/1 logs/line/machine.json logs/line/1.log.csv
diagnose 'line/a b' logs/line/machine.json 'logs/line/a b/log.csv' 'logs/line/a b/holdout.csv'
diagnose press logs/press.machine.json logs/press.log.csv

# A program that only hands out one of those answers; while "stuck" is there, three runs of it end and no other.
mkfifo never
cat >stub.sh <<STUB
#!/bin/sh
echo ran >>"$scratch/ran.txt"
while [ \$# -gt 0 ]; do
    case \$1 in --log) log=\$2 ;; --json) json=\$2 ;; --report) report=\$2 ;; esac
    shift
done
case \$log in *crash*) kill -SEGV \$\$ ;; esac
printf '{' >"\$json"
case \$log in *hang*) read -r nothing <"$scratch/never" ;; esac
[ ! -e "$scratch/stuck" ] || mkdir "$scratch/stuck/1" 2>/dev/null || mkdir "$scratch/stuck/2" 2>/dev/null ||
    mkdir "$scratch/stuck/3" 2>/dev/null || read -r nothing <"$scratch/never"
cat "$scratch/alone/press.diagnosis.json" >"\$json"
cat "$scratch/alone/press.html" >"\$report"
STUB
chmod +x stub.sh
mkdir many
cp logs/press.machine.json many/machine.json
for k in 01 02 03 04 05 06 07 08 09 10 11 12; do echo $k >many/$k.log.csv; done
whole() { # FOLDER: whatever has a name is whole
    for k in "$1"/*.diagnosis.json; do cmp "$k" alone/press.diagnosis.json || fail "$k is not whole"; done
    for k in "$1"/[01]*.html; do cmp "$k" alone/press.html || fail "$k is not whole"; done
}
ran() { wc -l <ran.txt | tr -d ' '; }
finished() { ls "$1" 2>/dev/null | grep -c '\.done\.json$' || true; }
in_ten_seconds() { # MESSAGE COMMAND...
    message=$1 tries=0
    shift
    until "$@"; do
        tries=$((tries + 1))
        [ $tries -lt 200 ] || fail "$message: $(cat said.txt)"
        sleep 0.05
    done
}
midway() { [ "$(finished "$1")" -ge 2 ] && [ "$(ran)" -ge $(($(finished "$1") + $2)) ]; }
none_of() { [ -z "$(grep -lsF "$1" /proc/[0-9]*/cmdline || true)" ]; } # the code of grep tells of those that vanish too
killed_and_resumed() { # JOBS FOLDER COMMAND...: killed when two or three are done, then run to the end
    jobs=$1 folder=$2
    shift 2
    : >ran.txt
    mkdir stuck
    "$@" many --program "$scratch/stub.sh" --out "$scratch/$folder" >said.txt 2>&1 &
    job=$!
    in_ten_seconds "nothing is done" midway "$folder" "$jobs"
    kill -KILL $job
    wait $job 2>/dev/null || true
    in_ten_seconds "what was killed leaves processes at work" none_of "$scratch/$folder"
    rm -r stuck
    whole "$folder"
    ended=$(finished "$folder")
    [ "$ended" -le 3 ] || fail "it was not killed midway but after $ended"
    : >ran.txt
    "$@" many --program "$scratch/stub.sh" --out "$scratch/$folder" >said.txt 2>&1 || fail "not resumed: $(cat said.txt)"
    says "12 logs: $ended done before, 0 failed before, $((12 - ended)) to do"
    [ "$(ran)" = $((12 - ended)) ] || fail "$(ran) diagnoses where $((12 - ended)) were missing"
    [ "$(finished "$folder")" = 12 ] || fail "in $folder are $(ls "$folder")"
    whole "$folder"
    [ -z "$(find "$folder" -name '.working-*')" ] || fail "a working folder is left in $folder"
    echo "ok: killed with $ended of 12 done, resumed"
}
