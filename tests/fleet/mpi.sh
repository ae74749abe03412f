#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# quadrant-gap-mpi in three processes: the results of one process, byte for byte; killed, it goes on where it was. Exit code 77
# (skipped) without MPI.   usage: mpi.sh PROGRAM ROOT SCRATCH [PROGRAM-OF-MPI]
set -eu
program=$1 root=$2 scratch=$3 mpi=${4-}
[ -n "$mpi" ] || { echo "quadrant-gap-mpi was not built (Debian packages libopenmpi-dev, openmpi-bin): skipped"; exit 77; }
command -v mpirun >/dev/null || { echo "no mpirun (Debian package openmpi-bin): skipped"; exit 77; }
. "$(dirname "$0")/common.sh"

# Open MPI refuses root, and more processes than cores, unless told so: this test's matter, not the program's.
mpirun="mpirun -n 3 --oversubscribe"
[ "$(id -u)" != 0 ] || mpirun="$mpirun --allow-run-as-root"
code=0
$mpirun "$mpi" logs --out spread >said.txt 2>&1 || code=$?
[ $code = 2 ] || fail "exit code $code: $(cat said.txt)"
same spread
says 'quadrant-gap-mpi: logs: 2 of 5 logs have no diagnosis'
killed_and_resumed 3 three $mpirun "$mpi"

# What one process began, three end.
"$program" fleet logs --out begun --quiet 2>said.txt || true
rm 'begun/line/a b.html' begun/press.done.json
$mpirun "$mpi" logs --out begun >said.txt 2>&1 || true
says '5 logs: 1 done before, 2 failed before (--retry does them again), 2 to do'
same begun

# A host with another quadrant-gap: the second process is given one.
cat >other.sh <<OTHER
#!/bin/sh
[ "\$OMPI_COMM_WORLD_RANK" != 1 ] || set -- "\$@" --program "$scratch/other.sh"
exec "$mpi" "\$@"
OTHER
chmod +x other.sh
code=0
$mpirun ./other.sh many --out odd >said.txt 2>&1 || code=$?
[ $code = 2 ] || fail "another program on one host ends with $code: $(cat said.txt)"
says 'its quadrant-gap is not the one of the first process'
code=0
$mpirun "$mpi" nowhere >said.txt 2>&1 || code=$?
[ $code = 2 ] || fail "a folder that is not there ends with $code: $(cat said.txt)"
says 'quadrant-gap-mpi: nowhere: no such folder'
echo 'ok: three processes'
