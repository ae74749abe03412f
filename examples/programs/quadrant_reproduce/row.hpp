// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../page/picture.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

/// What an experiment hands over: rows of figures, and pictures.
namespace quadrant_reproduce {

/// One figure beside those of the thesis; what is not there is empty. `simulated` is computed in the run,
/// always; the others stand in the experiment's file beside the table that they come from.
struct row {
    std::string id, quantity, unit;
    std::optional<double> simulated;             ///< empty: it diverged, and the note says so
    std::optional<double> published_simulated;   ///< by the thesis, in its simulation or on its model
    std::optional<double> published_measured;    ///< by the thesis, on its machine
    std::optional<double> reference_computation; ///< "ours" of shared/reference/thesis.md
    std::string note{};                          ///< why it differs, or how it was read
};

using quadrant_page::line;
using quadrant_page::panel;
using quadrant_page::picture;

/// Cases of one experiment that hand over pictures of the same title draw into one: their lines are put
/// together, panel by panel.
struct outcome {
    std::vector<row> rows;
    std::vector<picture> pictures{};
};

/// One line of `--list`: what --id names, and what computes it. Runs beside others: no shared state.
struct run_case {
    std::string id; ///< thesis.friction.x.gms; that of all its rows
    std::function<outcome()> run;
};

/// One section of the page.
struct experiment {
    std::string title;       ///< in plain words
    std::string source;      ///< equations and tables of the thesis
    std::string text;        ///< what is done, and why it differs where it does
    double tolerance = 0.02; ///< asked of simulated against reference_computation
    std::vector<run_case> cases{};
};

} // namespace quadrant_reproduce
