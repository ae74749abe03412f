#!/usr/bin/python3
# SPDX-License-Identifier: BSL-1.0
"""DISPLAY of the machine in its test: the panel is used as a person would use it, while the programs run.

panel_display.py -ini INI PANEL_FOLDER QUADRANT_GAP PROGRAM.ngc...
Writes panel.png, values.png and panel.txt (what the panel said) beside the INI file.
"""
import pathlib
import sys
import threading

ini = pathlib.Path(sys.argv[sys.argv.index("-ini") + 1]).resolve()
panel_folder, program = [a for a in sys.argv[1:] if a.startswith("/") and not a.endswith((".ini", ".ngc"))]
sys.path[:0] = [str(ini.parent), panel_folder]
import panel  # noqa: E402
import run_program as machine  # noqa: E402
from PyQt5 import QtCore, QtWidgets  # noqa: E402

application = QtWidgets.QApplication(sys.argv[:1])
window = panel.Panel(panel.given_by(["-ini", str(ini), "--program", program]))
window.show()
heard = []
window.status.setText = lambda text, show=window.status.setText: (heard.append(text), show(text))
result = {"ran": False, "diagnosed": None}


def programs():
    try:
        for each in machine.programs:
            machine.run(each)
        result["ran"] = True
    except SystemExit as fault:
        heard.append(f"machine: {fault}")


def wait(seconds, holds):
    loop, clock = QtCore.QEventLoop(), QtCore.QTimer(interval=100)
    left = [seconds * 10]

    def look():
        left[0] -= 1
        if holds() or left[0] < 0:
            loop.quit()
    clock.timeout.connect(look)
    clock.start()
    loop.exec_()
    return holds()


def shoot(name):
    wait(1, lambda: False)
    window.grab().save(str(ini.parent / name))
    screen = application.primaryScreen().grabWindow(int(window.winId()))  # what a web view draws is not in grab()
    screen.save(str(ini.parent / ("screen_" + name)))


window.finished.connect(lambda good: result.update(diagnosed=good))
machine.switched_on_and_homed()
window.record.click()
worker = threading.Thread(target=programs)
worker.start()
wait(300, lambda: not worker.is_alive())
window.record.click()
if result["ran"] and window.look.isEnabled():
    window.look.click()
    wait(300, lambda: result["diagnosed"] is not None)
    wait(4, lambda: False)
    shoot("panel.png")
    window.tabs.setCurrentWidget(window.table)
    shoot("values.png")
    if window.keep.isEnabled():
        window.keep.click()
(ini.parent / "panel.txt").write_text("\n".join(heard) + "\n\n" + window.text.toPlainText())
sys.exit(0 if result["diagnosed"] else 1)
