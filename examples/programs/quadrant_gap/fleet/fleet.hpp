// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <utility>

/// Many logs, each diagnosed by a process of its own: by one program (quadrant-gap fleet), or by one on every
/// host (quadrant-gap-mpi), with the same code for a log and for what is still to do.
namespace quadrant_gap::fleet {

struct options {
    std::string folder, out, program;
    std::size_t jobs = 0, threads = 0; ///< 0: what fits the machine
    double limit_s = 3600;
    bool retry = false, list = false, quiet = false, verbose = false;
};

void add_options(CLI::App& command, options& o);

/// The other processes of a run; none unless there are some.
struct crew {
    crew() = default;
    crew(const crew&) = delete;
    crew& operator=(const crew&) = delete;
    virtual ~crew() = default;
    virtual int others() const { return 0; }
    virtual void give(int /*to*/, const std::string& /*text*/) {}                      ///< to 1 ... others()
    virtual std::optional<std::pair<int, std::string>> hear() { return std::nullopt; } ///< from whom, what
};

/// Lists what is to do, has it done, writes the overview. Throws bad_input, also when a log has no diagnosis in
/// the end.
void lead(options o, crew& others);

/// The other end of a crew.
struct leader {
    leader() = default;
    leader(const leader&) = delete;
    leader& operator=(const leader&) = delete;
    virtual ~leader() = default;
    virtual void tell(const std::string& text) = 0;
    virtual std::optional<std::string> hear() = 0; ///< a task, or an empty text: that is all
};

/// Does what it is given until that is all.
void help(options o, leader& boss);

} // namespace quadrant_gap::fleet
