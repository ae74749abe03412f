// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/diagnosis/text/output_file.hpp>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <unistd.h>
#include <vector>

/// The files that a program is told to read and to write: no output destroys an input or another output.
namespace quadrant_page {

/// The name that stands for standard output.
inline constexpr std::string_view standard_output = "-";

/// Checked before anything is computed.
class outputs {
public:
    /// A file that is read; an empty path is none.
    outputs& reads(const std::string& option, const std::string& path) {
        if (!path.empty()) inputs_.push_back({option, path});
        return *this;
    }
    /// A file that will be written, or "-"; an empty path is none. Throws bad_input.
    outputs& writes(const std::string& option, const std::string& path) {
        if (path.empty()) return *this;
        for (const file& in : inputs_)
            if (same(in.path, path))
                refuse(path,
                       fmt::format("{} would destroy what {} reads: give it another name", option, in.option));
        for (const file& out : outputs_)
            if (same(out.path, path))
                refuse(path,
                       fmt::format("{} and {} cannot both be written to it: give one of them another name",
                                   out.option, option));
        outputs_.push_back({option, path});
        return *this;
    }
    /// Where words for a person go: to standard error when a file is written to standard output.
    std::FILE* words() const {
        for (const file& out : outputs_)
            if (out.path == standard_output) return stderr;
        return stdout;
    }

private:
    struct file {
        std::string option, path;
    };

    /// The same name, or two names of one file. A device that takes anything is no file.
    static bool same(const std::string& a, const std::string& b) {
        if (a == standard_output || b == standard_output) return a == b;
        std::error_code fault;
        if (std::filesystem::is_character_file(a, fault)) return false;
        if (std::filesystem::equivalent(a, b, fault)) return true;
        const auto whole = [&](const std::string& path) {
            return std::filesystem::weakly_canonical(std::filesystem::absolute(path, fault), fault);
        };
        return whole(a) == whole(b) && !fault;
    }
    [[noreturn]] static void refuse(const std::string& path, const std::string& why) {
        throw quadrant::diagnosis::bad_input(path, why);
    }
    std::vector<file> inputs_, outputs_;
};

/// Writes a whole file, or to standard output for "-". What standard output did not take is told by `ended`;
/// the other files are written all the same.
inline void write_output(const std::string& path, std::string_view text) {
    if (path != standard_output) return quadrant::diagnosis::write_aside(path, text);
    std::fwrite(text.data(), 1, text.size(), stdout);
}

/// The exit code of a program that would end with `code`: 1 and a line when not all of its standard output was
/// taken.
inline int ended(int code, const char* program) {
    constexpr int unwritten = 1;
    const bool lost = std::ferror(stdout) != 0;
    if (std::fflush(stdout) == 0 && !lost) return code;
    std::fprintf(stderr, "%s: standard output cannot be written\n", program);
    return code == 0 ? unwritten : code;
}

/// From now on memory that is refused ends the program at once, with one line and the code 2. For programs that
/// make JSON: the destructor of an nlohmann::json allocates (json_value::destroy), so std::bad_alloc
/// there, or while another one passes, would be std::terminate. No destructor runs: what is not
/// finished has no name yet (output_file), and such a program or subcommand keeps no scratch folder.
inline void end_without_memory(const char* program) {
    static const char* name;
    name = program;
    std::set_new_handler([] {
        constexpr int refused = 2;
        static std::atomic_flag said;
        while (said.test_and_set()) pause(); // another thread ends the program
        std::fprintf(stderr, "%s%s: out of memory\n", isatty(STDERR_FILENO) ? "\r\033[K" : "", name);
        std::_Exit(refused);
    });
}

/// The exit code of `program()`. What it throws (bad input, what this computer refuses, no memory to set up the
/// command line) becomes one line on standard error and the code `refused`; words that standard output does not
/// take (fmt::print throws) that of `ended`.
template <class Program> int guarded(const char* name, int refused, const Program& program) {
    try {
        return program();
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "%s: out of memory\n", name);
    } catch (const std::exception& e) {
        if (std::ferror(stdout) != 0) return ended(0, name);
        std::fprintf(stderr, "%s: %s\n", name, e.what());
    }
    return refused;
}

} // namespace quadrant_page
