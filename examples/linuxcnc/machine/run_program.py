#!/usr/bin/python3
# SPDX-License-Identifier: BSL-1.0
"""DISPLAY of a machine that nobody watches: switches it on, runs the programs named in the INI file, records them with
halsampler into [RECORD]FILE (beside it, in .programs: which rows are of which program), and ends LinuxCNC.
Exit code 1, with a line that says why, when the machine went off or something took too long."""
import subprocess
import sys
import threading
import time

import linuxcnc

ini = linuxcnc.ini(sys.argv[sys.argv.index("-ini") + 1])
programs = [a for a in sys.argv[1:] if a.endswith(".ngc")]
command, status, errors = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()
rows = 0


def keep(lines, path):
    global rows
    with open(path, "w") as record:
        for line in lines:
            record.write(line)
            rows += 1


def until(what, holds, seconds):
    end = time.monotonic() + seconds
    while True:
        status.poll()
        while (message := errors.poll()) is not None:
            print("LinuxCNC:", message[1], flush=True)
        if holds():
            return
        if time.monotonic() > end:
            sys.exit(f"{what}: not within {seconds} s")
        time.sleep(0.02)


def on():
    """A controller whose memory is still being designed has a fault until it is ready: asked again."""
    if status.task_state != linuxcnc.STATE_ON:
        command.state(linuxcnc.STATE_ON)
        command.wait_complete()
        time.sleep(0.5)
        status.poll()
    return status.task_state == linuxcnc.STATE_ON


def idle():
    if status.task_state != linuxcnc.STATE_ON:
        sys.exit("the machine went off")
    return status.interp_state == linuxcnc.INTERP_IDLE and status.inpos


def lost():
    return int(subprocess.check_output(["halcmd", "getp", "sampler.0.overruns"]))


def switched_on_and_homed():
    command.state(linuxcnc.STATE_ESTOP_RESET)
    until("emergency stop off", lambda: status.task_state != linuxcnc.STATE_ESTOP, 10)
    until("machine on", on, 20)
    command.mode(linuxcnc.MODE_MANUAL)
    command.wait_complete()
    command.teleop_enable(0)
    command.wait_complete()
    for joint in range(status.joints):
        command.home(joint)
        command.wait_complete()
    until("homed", lambda: all(status.homed[:status.joints]), 30)


def run(program):
    command.mode(linuxcnc.MODE_AUTO)
    command.wait_complete()
    command.program_open(program)
    command.auto(linuxcnc.AUTO_RUN, 0)
    command.wait_complete()
    until(program + " started", lambda: status.interp_state != linuxcnc.INTERP_IDLE, 10)
    until(program, idle, 600)


def main():
    switched_on_and_homed()
    path, before = ini.find("RECORD", "FILE"), lost()
    recorder = subprocess.Popen(["halsampler", "-t"], stdout=subprocess.PIPE, text=True)
    threading.Thread(target=keep, args=(recorder.stdout, path)).start()
    try:
        with open(path + ".programs", "w") as spans:
            for each in programs:
                time.sleep(0.5)  # halsampler hands on some 50 rows at once
                first = rows
                run(each)
                time.sleep(0.5)
                print(each, first, rows, file=spans, flush=True)
                if lost() > before:  # halsampler's own count goes on as if nothing were missing
                    sys.exit(f"{each}: sampler lost {lost() - before} rows: give it more depth")
    finally:
        recorder.terminate()


if __name__ == "__main__":
    main()
