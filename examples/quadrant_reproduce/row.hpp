// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// What an experiment hands over: rows of figures, and pictures.
namespace quadrant_reproduce {

/// One figure beside those of the thesis; what is not there is empty. `simulated` is computed in the run, always; the
/// others stand in the experiment's file beside the table that they come from.
struct row {
    std::string id, quantity, unit;
    std::optional<double> simulated;             ///< empty: it diverged, and the note says so
    std::optional<double> published_simulated;   ///< by the thesis, in its simulation or on its model
    std::optional<double> published_measured;    ///< by the thesis, on its machine
    std::optional<double> reference_computation; ///< "ours" of shared/reference/thesis.md
    std::string note{};                          ///< why it differs, or how it was read
};

/// A curve; points with a value that is not finite interrupt it.
struct line {
    std::string name;
    std::vector<double> x, y;
    enum class style { solid, dashed, points } drawn = style::solid;
};

/// One diagram. Panels of one picture stand below each other (Bode: gain, phase).
struct panel {
    std::string x_label, y_label;
    std::vector<line> lines;
    bool log_x = false, log_y = false;
    bool square = false; ///< equal scales: Nyquist
    bool polar = false;  ///< x in degrees, y as radius about `polar_zero`
    double polar_zero = 0;
    std::optional<std::pair<double, double>> x_range{}, y_range{};
};

/// Cases of one experiment that hand over pictures of the same title draw into one: their lines are put together, panel by
/// panel.
struct picture {
    std::string title, caption;
    std::vector<panel> panels;
};

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
