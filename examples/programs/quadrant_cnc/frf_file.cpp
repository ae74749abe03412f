// SPDX-License-Identifier: BSL-1.0
// A measured frequency response, line by line.
#include "frf_file.hpp"

#include <quadrant/diagnosis/text/csv_cells.hpp>
#include <quadrant/diagnosis/text/decimal.hpp>
#include <quadrant/diagnosis/text/text.hpp>

#include <optional>

namespace quadrant_cnc {

namespace qd = quadrant::diagnosis::detail;
using quadrant::diagnosis::bad_input;

namespace {

enum column : std::size_t { frequency_Hz, magnitude, phase, real, imaginary, coherence, columns };
constexpr std::array<std::string_view, columns> names{"frequency_Hz", "magnitude_m_per_V", "phase_deg",
                                                      "real_m_per_V", "imag_m_per_V",      "coherence"};

class frf_reader {
public:
    frf_reader(std::string_view text, std::string file, double servo_period)
        : rest_(qd::without_byte_order_mark(text)), half_rate_(0.5 / servo_period) {
        out_.file = std::move(file);
        rest_ = rest_.substr(0, rest_.find_last_not_of(" \t\r\n") + 1);
    }
    frf_file read() {
        if (rest_.empty()) throw bad_input(out_.file, "is empty");
        read_header();
        while (!rest_.empty()) read_row();
        constexpr std::size_t least = 10;
        if (out_.frf.lines.size() < least)
            throw bad_input(out_.file, fmt::format("holds {} frequencies: must hold {} or more",
                                                   out_.frf.lines.size(), least));
        return std::move(out_);
    }

private:
    [[noreturn]] void refuse(std::size_t offset, std::string_view message) const {
        throw bad_input(out_.file, number_, qd::characters(line_.substr(0, offset)) + 1, message);
    }
    void next_line() {
        const std::size_t end = rest_.find('\n');
        line_ = rest_.substr(0, end);
        rest_.remove_prefix(end == rest_.npos ? rest_.size() : end + 1);
        ++number_;
        if (line_.ends_with('\r')) line_.remove_suffix(1);
    }
    void read_header() {
        next_line();
        qd::csv_cells cells(line_);
        while (cells.next()) {
            const auto found = std::find(names.begin(), names.end(), cells.text());
            if (cells.broken() || found == names.end())
                refuse(cells.offset(), fmt::format("the column {} is none of {}", qd::in_quotes(cells.text()),
                                                   fmt::join(names, ", ")));
            const auto which = static_cast<column>(found - names.begin());
            if (has(which)) refuse(cells.offset(), fmt::format("the column {} is there twice", names[which]));
            order_.push_back(which);
        }
        const bool polar = has(magnitude) && has(phase), plain = has(real) && has(imaginary);
        const bool any_polar = has(magnitude) || has(phase), any_plain = has(real) || has(imaginary);
        if (!has(frequency_Hz)) refuse(0, "the header must name the column frequency_Hz");
        if (!(polar && !any_plain) && !(plain && !any_polar))
            refuse(0, "the header must name either magnitude_m_per_V and phase_deg, or real_m_per_V and "
                      "imag_m_per_V");
        out_.coherence = has(coherence);
    }
    bool has(column which) const { return std::find(order_.begin(), order_.end(), which) != order_.end(); }

    void read_row() {
        next_line();
        if (line_.find_first_not_of(" \t") == line_.npos) refuse(0, "a blank line inside the table");
        std::array<double, columns> value{};
        std::array<std::size_t, columns> at{};
        qd::csv_cells cells(line_);
        std::size_t index = 0;
        for (; cells.next(); ++index) {
            if (index == order_.size())
                refuse(cells.offset(), fmt::format("more cells than the {} of the header", order_.size()));
            const column which = order_[index];
            at[which] = cells.offset();
            if (const char* fault =
                    cells.broken() ? "is not a number" : qd::parse_number(cells.text(), value[which]))
                refuse(cells.offset(),
                       fmt::format("{}: {} {}", names[which], qd::in_quotes(cells.text()), fault));
        }
        if (index < order_.size())
            refuse(line_.size(), fmt::format("the row has {} cells, the header {}", index, order_.size()));
        take(value, at);
    }
    void take(const std::array<double, columns>& value, const std::array<std::size_t, columns>& at) {
        const auto wrong = [&](column which, std::string_view rule) {
            refuse(at[which], fmt::format("{}: {} {}", names[which], value[which], rule));
        };
        auto& lines = out_.frf.lines;
        const double f = value[frequency_Hz];
        if (!(f > 0)) wrong(frequency_Hz, "must be above 0");
        if (!lines.empty() && !(f > lines.back().f.value()))
            wrong(frequency_Hz,
                  fmt::format("must be above that of the row before ({})", lines.back().f.value()));
        if (!(f < half_rate_))
            wrong(frequency_Hz, fmt::format("must be below half the servo rate ({:.9g} Hz)", half_rate_));
        if (has(magnitude) && !(value[magnitude] > 0)) wrong(magnitude, "must be above 0");
        if (has(real) && value[real] == 0 && value[imaginary] == 0)
            wrong(real, "must not be 0 together with imag_m_per_V");
        if (has(coherence) && !(value[coherence] >= 0 && value[coherence] <= 1))
            wrong(coherence, "must lie between 0 and 1");
        const auto g = has(magnitude) ? std::polar(value[magnitude], value[phase] * std::numbers::pi / 180)
                                      : quadrant::analysis::complex(value[real], value[imaginary]);
        lines.push_back({quadrant::analysis::hertz(f), g, has(coherence) ? value[coherence] : 1, 0});
    }

    std::string_view rest_, line_{};
    double half_rate_;
    std::size_t number_ = 0;
    std::vector<column> order_{};
    frf_file out_{};
};

} // namespace

frf_file read_frf(const std::filesystem::path& path, double servo_period) {
    const std::string text = qd::read_whole(path);
    return frf_reader(text, path.string(), servo_period).read();
}

} // namespace quadrant_cnc
