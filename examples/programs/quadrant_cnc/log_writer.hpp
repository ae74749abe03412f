// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../page/outputs.hpp"

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace quadrant_cnc {

/// A log as quadrant-gap reads it (docs/formats.md): one row for each servo sample, numbers in fixed point.
class log_writer {
public:
    /// To standard output for "-".
    log_writer(const std::string& path, const std::string& header) : text_(header + "\n") {
        if (path != quadrant_page::standard_output) file_.emplace(path);
    }
    void number(double value, int decimals) {
        static constexpr double powers[] = {1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12};
        char buffer[32];
        char* at = buffer + sizeof buffer;
        const std::int64_t whole = std::llround(value * powers[decimals]);
        std::uint64_t left = whole < 0 ? 0 - std::uint64_t(whole) : std::uint64_t(whole);
        for (int i = 0; i < decimals || left > 0 || i == decimals; ++i) {
            if (i == decimals && decimals > 0) *--at = '.';
            *--at = char('0' + left % 10);
            left /= 10;
        }
        if (whole < 0) *--at = '-';
        if (!text_.empty() && text_.back() != '\n') text_ += ',';
        text_.append(at, std::size_t(buffer + sizeof buffer - at));
    }
    void end_row() {
        text_ += '\n';
        if (text_.size() > 1 << 16) flush();
    }
    void finish() {
        flush();
        if (file_) file_->finish();
    }

private:
    void flush() {
        if (file_)
            file_->write(text_);
        else
            quadrant_page::write_output(std::string(quadrant_page::standard_output), text_);
        text_.clear();
    }
    std::optional<quadrant::diagnosis::output_file> file_{};
    std::string text_;
};

} // namespace quadrant_cnc
