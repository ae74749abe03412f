# SPDX-License-Identifier: BSL-1.0
# Conan 2. Not tested: no Conan where this was written. conan create packaging/conan
import os
import re

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load


class Quadrant(ConanFile):
    name = "quadrant"
    license = "BSL-1.0"
    description = "Servo-axis control blocks, header-only"
    package_type = "header-library"
    settings = "os", "compiler", "build_type", "arch"
    options = {"diagnosis": [True, False]}
    default_options = {"diagnosis": False}
    _root = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")

    def set_version(self):
        header = load(self, os.path.join(self._root, "include", "quadrant", "version.hpp"))
        self.version = ".".join(re.findall(r"#define QUADRANT_VERSION_\w+ (\d+)", header))

    def export_sources(self):
        for what in ("CMakeLists.txt", "LICENSE", "include/*", "packaging/*"):
            copy(self, what, self._root, self.export_sources_folder)

    def requirements(self):
        self.requires("boost/[>=1.74 <2]")
        if self.options.diagnosis:
            self.requires("eigen/[>=3.4 <4]")
            self.requires("nlohmann_json/[>=3.11 <4]")
            self.requires("fmt/[>=9]")

    def validate(self):
        check_min_cppstd(self, 20)

    def layout(self):
        cmake_layout(self)

    def generate(self):
        toolchain = CMakeToolchain(self)
        for what in ("TESTS", "EXAMPLES", "BENCHMARKS"):
            toolchain.variables[f"QUADRANT_BUILD_{what}"] = False
        toolchain.generate()

    def package(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.install(component="dev")
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))

    def package_id(self):
        self.info.clear()

    def package_info(self):
        self.cpp_info.bindirs = []
        self.cpp_info.libdirs = []
        self.cpp_info.components["core"].set_property("cmake_target_name", "quadrant::quadrant")
        self.cpp_info.components["core"].requires = ["boost::headers"]
        if self.options.diagnosis:
            self.cpp_info.components["diagnosis"].set_property("cmake_target_name", "quadrant::diagnosis")
            self.cpp_info.components["diagnosis"].requires = [
                "core", "eigen::eigen", "nlohmann_json::nlohmann_json", "fmt::fmt"]
