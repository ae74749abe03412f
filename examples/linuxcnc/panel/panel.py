#!/usr/bin/python3
# SPDX-License-Identifier: BSL-1.0
# Long: one window: its recorder, its worker, its buttons.
"""A panel beside LinuxCNC: record the servo loop, find out why the machine does not do what its simulation says, read the
report, and save the values for the next start.

panel.py -ini MACHINE.ini [--machine machine.json] [--map record.map.json] [--program quadrant-gap] [--folder FOLDER]

In the INI file:  [APPLICATIONS] APP = panel.py -ini quadrant.ini
`sampler` must be loaded and wired (machine/plant.hal); the import map says which of its pins is what. Needs python3-pyqt5; with
python3-pyqt5.qtwebengine the report is shown in the panel, else in the browser.
"""
import argparse
import html
import pathlib
import re
import subprocess
import sys
import threading

from PyQt5 import QtCore, QtGui, QtWidgets

try:
    from PyQt5.QtWebEngineWidgets import QWebEngineView
except ImportError:
    QWebEngineView = None

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import values  # noqa: E402


class Refused(Exception):
    """What a program said when it did not do what it was asked for."""


def halcmd_number(pin):
    return int(subprocess.check_output(["halcmd", "getp", pin], text=True))


class Recorder:
    """halsampler into a file, until it is stopped; lost rows are told."""

    def __init__(self, path, channel=0):
        self.path, self.pin = pathlib.Path(path), f"sampler.{channel}.overruns"
        self.before, self.rows, self.process = 0, 0, None

    def start(self):
        self.before, self.rows = halcmd_number(self.pin), 0
        self.process = subprocess.Popen(["halsampler", "-t"], stdout=subprocess.PIPE, text=True)
        self.reader = threading.Thread(target=self._keep, daemon=True)
        self.reader.start()

    def _keep(self):
        with open(self.path, "w") as file:
            for line in self.process.stdout:
                file.write(line)
                self.rows += 1

    def stop(self):
        """Rows recorded. Raises Refused where some were lost: the rest would look like a machine with a jump."""
        self.process.terminate()
        self.process.wait()
        self.reader.join()
        text = self.path.read_text()
        self.path.write_text(text[:text.rfind("\n") + 1])  # the last line may be cut
        lost = halcmd_number(self.pin) - self.before
        if lost:
            raise Refused(f"sampler lost {lost} rows: give it more depth (loadrt sampler depth=...)")
        if self.rows < 2:
            raise Refused("nothing was recorded: is sampler loaded and its function in the thread?")
        return self.rows


class Work(QtCore.QThread):
    """Import, diagnosis, corrected machine file and its lines for LinuxCNC, by quadrant-gap; beside the window."""
    said = QtCore.pyqtSignal(str)
    failed = QtCore.pyqtSignal(str)
    done = QtCore.pyqtSignal()

    def __init__(self, given, record):
        super().__init__()
        self.given, self.record, self.child = given, record, None
        self.out = {name: given.folder / file for name, file in dict(
            log="log.csv", found="diagnosis.json", report="report.html", machine="corrected.json", lines="linuxcnc.txt").items()}
        self.words = self.lines = ""

    def ask(self, *words):
        self.child = subprocess.Popen([self.given.program, *map(str, words)], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                      stderr=subprocess.PIPE, text=True)
        heard = []
        for line in self.child.stderr:
            heard.append(line.strip())
            self.said.emit(line.strip())
        text = self.child.stdout.read()
        if self.child.wait():
            raise Refused(heard[-1] if heard else f"{words[0]} ended with code {self.child.returncode}")
        return text

    def run(self):
        out, given = self.out, self.given
        try:
            self.said.emit("importing the record")
            self.ask("import", "--map", given.map, self.record, out["log"])
            self.said.emit("looking for the cause")
            self.words = self.ask("diagnose", "--verbose", "--machine", given.machine, "--log", out["log"], "--json", out["found"],
                                  "--report", out["report"])
            self.said.emit("values for the next start")
            self.ask("apply", "--machine", given.machine, "--diagnosis", out["found"], "--out", out["machine"])
            self.ask("export", "--machine", out["machine"], "--linuxcnc", out["lines"])
            self.lines = out["lines"].read_text()
        except (Refused, OSError) as fault:
            self.failed.emit(str(fault))
            return
        self.done.emit()

    def cancel(self):
        if self.child and self.child.poll() is None:
            self.child.terminate()


class Panel(QtWidgets.QWidget):
    finished = QtCore.pyqtSignal(bool)  # of a diagnosis: whether there is one

    def __init__(self, given):
        super().__init__()
        self.given = given
        given.folder.mkdir(parents=True, exist_ok=True)
        self.recorder, self.work, self.proposal = Recorder(given.folder / "record.txt", given.channel), None, []
        self.setWindowTitle("Quadrant: why does the machine not do what its simulation says?")
        self.resize(1100, 860)
        self.record = QtWidgets.QPushButton("&Record", clicked=self.toggle_recording)
        self.look = QtWidgets.QPushButton("&Find the cause", clicked=self.diagnose, enabled=False)
        self.keep = QtWidgets.QPushButton("&Save for the next start", clicked=self.save, enabled=False)
        self.status = QtWidgets.QLabel("Record while the machine moves as it does in work: reversals, slow and fast strokes.", wordWrap=True)
        self.text = QtWidgets.QPlainTextEdit(readOnly=True)
        self.text.setFont(QtGui.QFontDatabase.systemFont(QtGui.QFontDatabase.FixedFont))
        self.table = QtWidgets.QTableWidget(0, 4)
        self.table.setHorizontalHeaderLabels(["Save", "Entry of the INI file", "Now", "New"])
        self.table.horizontalHeader().setStretchLastSection(True)
        self.tabs = QtWidgets.QTabWidget()
        self.report = QWebEngineView() if QWebEngineView else QtWidgets.QPushButton("Open the report in the browser", clicked=self.browse)
        for widget, title in ((self.report, "Report"), (self.text, "In words"), (self.table, "Values")):
            self.tabs.addTab(widget, title)
        buttons = QtWidgets.QHBoxLayout()
        for button in (self.record, self.look, self.keep):
            buttons.addWidget(button)
        buttons.addStretch()
        layout = QtWidgets.QVBoxLayout(self)
        layout.addLayout(buttons)
        layout.addWidget(self.status)
        layout.addWidget(self.tabs, 1)
        self.clock = QtCore.QTimer(self, interval=500, timeout=self.tell_rows)

    def tell(self, text):
        self.status.setText(text)

    def tell_rows(self):
        self.tell(f"Recording: {self.recorder.rows} rows")

    def toggle_recording(self):
        """Starts a record, or ends it. True while it records."""
        try:
            if not self.clock.isActive():
                self.recorder.start()
                self.clock.start()
                self.record.setText("&Stop")
                self.look.setEnabled(False)
                return True
            self.clock.stop()
            self.record.setText("&Record")
            rows = self.recorder.stop()
            self.tell(f"{rows} rows in {self.recorder.path}")
            self.look.setEnabled(True)
        except (Refused, OSError, subprocess.CalledProcessError) as fault:
            self.clock.stop()
            self.record.setText("&Record")
            self.tell(str(fault))
        return False

    def diagnose(self):
        if self.work and self.work.isRunning():
            self.work.cancel()
            return
        self.work = Work(self.given, self.recorder.path)
        self.work.said.connect(self.tell)
        self.work.failed.connect(lambda why: self.end(False, why))
        self.work.done.connect(lambda: self.end(True))
        self.look.setText("&Cancel")
        self.keep.setEnabled(False)
        self.work.start()

    def end(self, good, why=""):
        self.look.setText("&Find the cause")
        if not good:
            self.tell(why or "Cancelled.")
            self.finished.emit(False)
            return
        self.text.setPlainText(self.work.words)
        head = re.search(r"<h1[^>]*>(.*?)</h1>", self.work.out["report"].read_text(), re.S)
        self.tell(html.unescape(head.group(1)) if head else "Done.")
        if QWebEngineView:
            self.report.load(QtCore.QUrl.fromLocalFile(str(self.work.out["report"])))
        self.propose()
        self.finished.emit(True)

    def propose(self):
        """What the INI file would change to, all of it ticked."""
        self.proposal = values.changes(values.read(self.given.ini), self.work.lines)
        self.table.setRowCount(len(self.proposal))
        for row, (section, key, now, new) in enumerate(self.proposal):
            tick = QtWidgets.QTableWidgetItem()
            tick.setFlags(QtCore.Qt.ItemIsUserCheckable | QtCore.Qt.ItemIsEnabled)
            tick.setCheckState(QtCore.Qt.Checked)
            self.table.setItem(row, 0, tick)
            for column, text in enumerate((f"[{section}] {key}", now, new), 1):
                item = QtWidgets.QTableWidgetItem(text)
                item.setFlags(QtCore.Qt.ItemIsEnabled)
                self.table.setItem(row, column, item)
        self.table.resizeColumnsToContents()
        self.keep.setEnabled(bool(self.proposal))

    def save(self):
        """The ticked values into the INI file, which LinuxCNC reads at its next start."""
        chosen = [p for row, p in enumerate(self.proposal) if self.table.item(row, 0).checkState() == QtCore.Qt.Checked]
        try:
            before = values.save(self.given.ini, values.with_changes(values.read(self.given.ini), chosen))
        except OSError as fault:
            self.tell(str(fault))
            return
        self.keep.setEnabled(False)
        self.tell(f"{len(chosen)} values are in {self.given.ini.name}, for the next start; {before.name} is how it was.")

    def browse(self):
        if self.work:
            QtGui.QDesktopServices.openUrl(QtCore.QUrl.fromLocalFile(str(self.work.out["report"])))

    def closeEvent(self, event):
        if self.clock.isActive():
            self.toggle_recording()
        if self.work and self.work.isRunning():
            self.work.cancel()
            self.work.wait()
        super().closeEvent(event)


def given_by(arguments):
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0], fromfile_prefix_chars="@")
    parser.add_argument("-ini", "--ini", required=True, type=pathlib.Path)
    parser.add_argument("--machine", type=pathlib.Path, help="default: machine.json beside the INI file")
    parser.add_argument("--map", type=pathlib.Path, help="default: record.map.json beside the INI file")
    parser.add_argument("--program", default="quadrant-gap")
    parser.add_argument("--folder", type=pathlib.Path, help="of what is recorded and found; default: diagnosed beside the INI file")
    parser.add_argument("--channel", type=int, default=0, help="of sampler")
    given = parser.parse_args(arguments)
    given.ini = given.ini.resolve()
    given.machine = given.machine or given.ini.with_name("machine.json")
    given.map = given.map or given.ini.with_name("record.map.json")
    given.folder = (given.folder or given.ini.with_name("diagnosed")).resolve()
    return given


def main():
    application = QtWidgets.QApplication(sys.argv[:1])
    panel = Panel(given_by(sys.argv[1:]))
    panel.show()
    sys.exit(application.exec_())


if __name__ == "__main__":
    main()
