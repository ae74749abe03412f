# SPDX-License-Identifier: BSL-1.0
"""Builds quadrant._core with CMake, in the repository that this folder lies in, and puts it into the package.

QUADRANT_BUILD: folder for what is compiled (default: build in the repository; a temporary one where that cannot be written)
QUADRANT_PYTHON_MODULE: a module that was compiled already (target quadrant_python), taken as it is
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

root = pathlib.Path(__file__).resolve().parents[2]
numbers = re.findall(r"#define QUADRANT_VERSION_\w+ (\d+)", (root / "include/quadrant/base/version.hpp").read_text())


def build_folder():
    """Nothing is left beside the sources."""
    folder = pathlib.Path(os.environ.get("QUADRANT_BUILD", root / "build"))
    try:
        folder.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
        return folder
    except OSError:
        return pathlib.Path(tempfile.mkdtemp(prefix="quadrant-"))


class by_cmake(build_ext):
    def build_extension(self, ext):
        out = pathlib.Path(self.get_ext_fullpath(ext.name)).resolve()
        out.parent.mkdir(parents=True, exist_ok=True)
        made = os.environ.get("QUADRANT_PYTHON_MODULE")
        if not made:
            where = build / "python"
            generator = ["-G", "Ninja"] if shutil.which("ninja") and not where.exists() else []
            subprocess.check_call(["cmake", *generator, "-S", root, "-B", where, "-DCMAKE_BUILD_TYPE=Release", "-DQUADRANT_PYTHON_ALONE=ON",
                                   "-DQUADRANT_BUILD_TESTS=OFF", "-DQUADRANT_BUILD_BENCHMARKS=OFF",
                                   f"-DPython3_EXECUTABLE={sys.executable}"])
            subprocess.check_call(["cmake", "--build", where, "--target", "quadrant_python", "--parallel",
                                   str(os.cpu_count() or 1)])
            made, = (where / "examples/python/quadrant").glob("_core*.so")
        shutil.copyfile(made, out)


build = build_folder()
(build / "python-package").mkdir(exist_ok=True)
setup(version=".".join(numbers), ext_modules=[Extension("quadrant._core", sources=[])], cmdclass={"build_ext": by_cmake},
      options={"build": {"build_base": str(build / "python-package")}, "egg_info": {"egg_base": str(build / "python-package")}})
