#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# From numbers and a log to a corrected machine file, by the subcommands in turn; and what each of them refuses.
# usage: files.sh PROGRAM ROOT SCRATCH
set -eu
program=$1 root=$2 scratch=$3
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"
data=$root/examples/data

refuses() { # WORDS ARGUMENTS...
    words=$1 code=0
    shift
    "$program" "$@" </dev/null >said.txt 2>&1 || code=$?
    [ "$code" = 2 ] || { echo "exit code $code, not 2: $*: $(cat said.txt)"; exit 1; }
    grep -qF -- "$words" said.txt || { echo "does not say '$words': $(cat said.txt)"; exit 1; }
    echo "ok: $(head -n 1 said.txt)"
}
force_gap() { # MACHINE: rms on the other log [N]
    "$program" simulate --quiet --machine "$1" --log "$data/holdout.csv" --json simulated.json
    sed -n 's/.*"force_rms_N": \([0-9.e+-]*\).*/\1/p' simulated.json
}

# diagnose, apply, simulate: the gap on another log shrinks, and a diagnosis is applied once.
"$program" diagnose --verbose --threads 1 --machine "$data/machine.json" --log "$data/log.csv" --json found.json >/dev/null 2>how_far.txt
# How far it is never falls, and is all of it at the end; after half a second it says how long the rest will take.
awk '{ if ($1 + 0 < last || $2 !~ /^%/) exit 1; last = $1 + 0 } END { exit !(NR > 20 && last == 100) }' how_far.txt
grep -q ' %, about [0-9]* s left: x: trying ' how_far.txt
"$program" apply --machine "$data/machine.json" --diagnosis found.json --out better.json | tee changes.txt
grep -q '^axes.x.plant.static_N: absent -> ' changes.txt
before=$(force_gap "$data/machine.json") after=$(force_gap better.json)
echo "force gap on the other log: $before N, then $after N"
awk "BEGIN { exit !($after < 0.5 * $before) }"
"$program" simulate --verbose --machine better.json --log "$data/holdout.csv" --report simulated.html >simulated.txt
grep -q 'force remain where sensor noise' simulated.txt
grep -q '</html>' simulated.html
[ -z "$("$program" apply --quiet --machine "$data/machine.json" --diagnosis found.json --out better.json)" ]
# forecast: what shrinks on the other motion, known by its reference only, comes within ten points of what did.
cut -d, -f1,2 "$data/holdout.csv" >planned.csv
head -n 1 planned.csv | grep -qx 't_s,x_ref_m'
"$program" forecast --machine "$data/machine.json" --diagnosis found.json --motion planned.csv --json expected.json | tee expected.txt
grep -q 'the gap shrinks by' expected.txt
expected=$(sed -n 's/.*"shrink": \([0-9.e+-]*\).*/\1/p' expected.json)
awk "BEGIN { d = $expected - (1 - $after / $before); exit !(d < 0.1 && d > -0.1) }"
printf 't_s,x_pos_m\n0,1\n0.0005,1\n' >no_reference.csv
"$program" forecast --quiet --machine "$data/machine.json" --diagnosis found.json --motion planned.csv --json again.json --at-least 1
# ... and with nothing but the calibrated values it is far smaller.
shrinks=$(sed -n 's/.*"shrink": \([0-9.e+-]*\).*/\1/p' again.json)
awk "BEGIN { exit !($shrinks < 0.3 * $expected) }" # nothing is that sure: nothing corrected, nothing gained
rm again.json
refuses 'column x_pos_m is missing' simulate --machine better.json --log planned.csv
refuses 'no axis: columns such as x_ref_m' forecast --machine "$data/machine.json" --diagnosis found.json --motion no_reference.csv
refuses 'has stribeck_friction already' apply --machine better.json --diagnosis found.json --out again.json
refuses 'schema: must be "quadrant.diagnosis/1"' apply --machine better.json --diagnosis better.json --out again.json
sed 's/"x": {/"z": {/' "$data/machine.json" >z.json
refuses 'axes.x: is missing; the diagnosis is of another machine' apply --machine z.json --diagnosis found.json --out again.json
refuses 'axis x is not described' simulate --machine z.json --log "$data/log.csv"
refuses 'not in range' apply --machine better.json --diagnosis found.json --out again.json --at-least 2
refuses 'excludes' apply --machine better.json --diagnosis found.json --out again.json --at-least 1 --all
[ ! -e again.json ]

# Two seconds of the same log as a rotary axis: every file in rad and N m, from the diagnosis to what is left.
head -n 4500 "$data/log.csv" >short.csv
sed '1s/x_ref_m,x_pos_m/x_ref_rad,x_pos_rad/' short.csv >turning.csv
sed 's/mass_kg/inertia_kg_m2/; s/force_constant_N_per_V/torque_constant_Nm_per_V/; s/N_s_per_m/Nm_s_per_rad/; s/coulomb_N"/coulomb_Nm"/
    s/"mass"/"inertia"/; s/"force_constant"/"torque_constant"/; s/resolution_m"/resolution_rad"/; s/_per_m"/_per_rad"/g' \
    "$data/machine.json" >turning.json
"$program" diagnose --verbose --machine turning.json --log turning.csv --json found_turning.json --report turned.html >turned.txt 2>/dev/null
grep -q '"torque_rms_Nm"' found_turning.json
grep -q '"kind": "rotary"' found_turning.json
! grep -E '_N"|_m"|_kg"|force_rms' found_turning.json
grep -q 'torque, rms' turned.txt
! grep -E '[0-9] (m?N|kN|[nµm]?m|m/s)( |$|\.|,)' turned.txt | grep -v 'N m'
grep -q 'torque \[N m\]' turned.html
"$program" apply --machine turning.json --diagnosis found_turning.json --out turned_better.json --all >turned_changes.txt
! grep -E '_N:|_m:|_kg:' turned_changes.txt
before=$("$program" simulate --quiet --machine turning.json --log turning.csv --json s.json && sed -n 's/.*"torque_rms_Nm": \([0-9.e+-]*\).*/\1/p' s.json)
after=$("$program" simulate --quiet --machine turned_better.json --log turning.csv --json s.json && sed -n 's/.*"torque_rms_Nm": \([0-9.e+-]*\).*/\1/p' s.json)
echo "torque gap of the same log as a rotary axis: $before N m, then $after N m"
awk "BEGIN { exit !($after < 0.7 * $before) }"
refuses 'axis x is rotary in the log, linear in' diagnose --machine "$data/machine.json" --log turning.csv
sed 's/coulomb_Nm/coulomb_N/' turning.json >mixed.json
refuses 'mixed.json:6:' diagnose --machine mixed.json --log turning.csv
refuses 'axes.x.plant.coulomb_N: belongs to a linear axis; this one is rotary: coulomb_Nm' diagnose --machine mixed.json --log turning.csv

# The diagnosis knows its files: apply says when the machine file is another one.
[ "$(sed -n '/"machine"/,/}/s/.*"sha256": "\(.*\)".*/\1/p' found.json)" = "$(sha256sum <"$data/machine.json" | cut -d' ' -f1)" ]
[ "$(sed -n '/"log"/,/}/s/.*"sha256": "\(.*\)".*/\1/p' found.json)" = "$(sha256sum <"$data/log.csv" | cut -d' ' -f1)" ]
! grep 'byte for byte' changes.txt
sed 's/0.05, "static"/0.051, "static"/' "$data/machine.json" >touched.json
"$program" apply --machine touched.json --diagnosis found.json --out better_touched.json | grep -q 'Note: touched.json is not, byte for byte,'

# compensate: what a feedforward would gain on the log, and what of it the controller has keys for.
"$program" compensate --machine "$data/machine.json" --diagnosis found.json --log "$data/log.csv" --json gained.json \
    --controller patch.json >gained.txt
grep -q 'friction_feedforward (against Stribeck friction): takes the error from' gained.txt
grep -q '"claimed": true' gained.json
grep -q '"coulomb_feedforward_V"' patch.json
refuses 'axis x is not described' compensate --machine z.json --diagnosis found.json \
    --log "$data/log.csv"
refuses 'has stribeck_friction already' compensate --machine better.json --diagnosis found.json --log "$data/log.csv"
refuses 'schema: must be "quadrant.diagnosis/1"' compensate --machine better.json --diagnosis better.json --log "$data/log.csv"

refuses 'axes.x: is rotary; feedforwards are built for linear axes only' compensate --machine turning.json \
    --diagnosis found_turning.json --log turning.csv

# import: the samples that are shipped, then what is wrong with them.
for sample in halsampler.txt odrive.csv twincat_scope.csv; do
    "$program" import --map "$root/examples/import/${sample%.*}.map.json" "$root/examples/import/$sample" "${sample%.*}.csv"
done
head -n 1 odrive.csv | grep -qx 't_s,c_ref_rad,c_pos_rad,c_cmd_Nm'
# Without a map: what the header says is taken, told, and can be had as a map; what it does not say is asked for.
"$program" import "$root/examples/import/odrive.csv" guessed.csv </dev/null | grep -q 'guessed from the header, as ODrive writes it'
head -n 1 guessed.csv | grep -qx 't_s,axis0_ref_rad,axis0_pos_rad,axis0_cmd_Nm'
"$program" import --propose "$root/examples/import/odrive.csv" odrive.map.json >said.txt
"$program" import --quiet --map odrive.map.json "$root/examples/import/odrive.csv" mapped.csv
cmp guessed.csv mapped.csv
refuses 'of TwinCAT Scope, which does not say: which column is the command of x' import "$root/examples/import/twincat_scope.csv" l2.csv
refuses 'of halsampler, which does not say: the period' import "$root/examples/import/halsampler.txt" l2.csv
refuses 'bring it in first, with "quadrant-gap import' init --log "$root/examples/import/odrive.csv" --out m2.json
"$program" import --propose "$root/examples/import/twincat_scope.csv" scope.map.json | grep -q 'To put in: the unit of MAIN.AxisY.NcToPlc.ActPos'
refuses '"?" is not a unit' import --map scope.map.json "$root/examples/import/twincat_scope.csv" l2.csv
python3 - <<'END'
import json
m = json.load(open("scope.map.json"))
for role in ("position", "reference"):
    m["axes"]["x"][role]["unit"] = "mm"
m["axes"]["x"]["command"] = {"column": "MAIN.nTorqueY", "unit": "A", "scale": 0.0045}
json.dump(m, open("scope.map.json", "w"))
END
"$program" import --quiet --map scope.map.json "$root/examples/import/twincat_scope.csv" scope.csv
tail -n +2 twincat_scope.csv >a.csv
tail -n +2 scope.csv | cmp - a.csv
refuses 'is no table: none of its first 60 lines is a row of numbers' import --propose said.txt l2.json
printf '{"test": [[0, 1], [1, 2]]}\n' >sysid.json
refuses 'is JSON, no table' import sysid.json l2.json
# Any other table: by the words of its columns' names, and the rest is asked for.
sed '1s/.*/Time (s),Target angle (rad),Angle (rad),Torque (Nm)/' odrive.csv >other.csv
refuses 'no column such as x_pos_m' import other.csv l2.csv
"$program" import --propose other.csv other.map.json | grep -q 'To put in: whether Torque (Nm) is asked'
"$program" import --quiet --map other.map.json other.csv l3.csv
tail -n +2 odrive.csv >a.csv
tail -n +2 l3.csv | cmp - a.csv
sed 300d "$root/examples/import/halsampler.txt" >lost.txt
"$program" import --map "$root/examples/import/halsampler.map.json" lost.txt l.csv | grep -q '1 rows are missing in 1 places'
sed 's/"unit": "V"/"unit": "V", "scale": -1/' "$root/examples/import/halsampler.map.json" >turned.json
refuses 'the command drives against the acceleration' import --map turned.json "$root/examples/import/halsampler.txt" l.csv
refuses 'of the mass of 8000' import --map "$root/examples/import/halsampler.map.json" --mass 8000 --force-constant 400 \
    "$root/examples/import/halsampler.txt" l.csv
"$program" import --quiet --unchecked --map turned.json "$root/examples/import/halsampler.txt" l.csv
refuses 'no column "time"' import --map "$root/examples/import/odrive.map.json" halsampler.csv l2.csv
[ ! -e l2.csv ]

# init: from a log and options, from questions, and a machine file that simulate takes.
"$program" init --out begun.json --log halsampler.csv --mass 80kg --force-constant 400 --coulomb 25 --viscous 100 </dev/null
grep -q '"mass_kg": 80' begun.json
grep -q 'axes.x.plant.mass_kg' begun.md
"$program" simulate --machine begun.json --log halsampler.csv >/dev/null
printf '80\n400\n\n0.4ms\n' | "$program" init --questions --quiet --out asked.json --log halsampler.csv 2>asked.txt
grep -q 'moving mass' asked.txt
printf 'yes\n0.02\n\n' | "$program" init --questions --out rotary.json --sample-period 0.001 --quiet 2>asked.txt
grep -q 'moving inertia' asked.txt
grep -q '"inertia_kg_m2": 0.02' rotary.json
refuses 'axis c: --inertia is missing' init --out no.json --log odrive.csv
grep -q '"delay_s": 0.0004' asked.json
refuses '--mass is missing; the log indicates about 8' init --out no.json --log halsampler.csv --force-constant 400
refuses 'is not a number of kg' init --out no.json --log halsampler.csv --mass 80mm --force-constant 400
refuses 'contradict this log' init --out no.json --log halsampler.csv --mass 80000 --force-constant 400
[ ! -e no.json ]

# The same options and exit codes everywhere; the completion offers what the help has.
refuses 'subcommand is required'
for subcommand in diagnose apply simulate compensate init import; do
    "$program" $subcommand --help | grep -q -- '--quiet'
    "$program" $subcommand --version >/dev/null
    refuses 'Run with --help' $subcommand --nonsense
done
[ "$("$program" --version)" = "$("$program" apply --version)" ]
if command -v bash >/dev/null; then
    mkdir -p bin && ln -sf "$program" bin/quadrant-gap
    PATH=$PWD/bin:$PATH bash -c 'set -e; . "$1"
        COMP_WORDS=(quadrant-gap a) COMP_CWORD=1; _quadrant_gap; [ "${COMPREPLY[*]}" = apply ]
        COMP_WORDS=(quadrant-gap apply --at) COMP_CWORD=2; _quadrant_gap; [ "${COMPREPLY[*]}" = --at-least ]
        for s in $(quadrant-gap --help | sed -n "/^Subcommands:/,\$s/^  \([a-z]*\) .*/\1/p"); do
            COMP_WORDS=(quadrant-gap "$s" -) COMP_CWORD=2; _quadrant_gap
            for option in $(quadrant-gap "$s" --help | awk "/^  -/ { print \$1 }" | tr , " "); do
                case " ${COMPREPLY[*]} " in *" $option "*) ;; *) echo "$s $option is not completed"; exit 1 ;; esac
            done
        done' - \
        "$root/examples/programs/quadrant_gap/quadrant-gap.bash"
    echo 'ok: completion'
fi
