// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/diagnosis/bad_input.hpp>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <unistd.h>
#include <utility>

namespace quadrant_cnc {

/// A file that is written piece by piece beside its name and renamed when it is whole: what is refused on the way leaves
/// nothing behind.
class growing_file {
public:
    explicit growing_file(const std::filesystem::path& path) : path_(path), aside_(path) {
        aside_ += fmt::format(".tmp-{}", getpid());
        file_ = std::fopen(aside_.c_str(), "wb");
        if (!file_) fail();
    }
    growing_file(const growing_file&) = delete;
    growing_file& operator=(const growing_file&) = delete;
    ~growing_file() {
        if (!file_) return;
        std::fclose(file_);
        std::error_code ignored;
        std::filesystem::remove(aside_, ignored);
    }
    void write(std::string_view text) {
        if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail();
    }
    void finish() {
        FILE* const file = std::exchange(file_, nullptr);
        std::error_code fault;
        if (std::fclose(file) == 0)
            std::filesystem::rename(aside_, path_, fault);
        else
            fault = std::make_error_code(std::errc::io_error);
        if (fault) fail();
    }

private:
    [[noreturn]] void fail() {
        std::error_code ignored;
        std::filesystem::remove(aside_, ignored);
        const bool no_folder =
            path_.has_parent_path() && !std::filesystem::exists(path_.parent_path(), ignored);
        throw quadrant::diagnosis::bad_input(path_.string(), no_folder ? "cannot be written: no such folder"
                                                                       : "cannot be written");
    }
    std::filesystem::path path_, aside_;
    FILE* file_ = nullptr;
};

/// A log as quadrant-gap reads it (docs/formats.md): one row for each servo sample, numbers in fixed point.
class log_writer {
public:
    log_writer(const std::filesystem::path& path, const std::string& header) : file_(path) {
        text_ = header + "\n";
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
        file_.finish();
    }

private:
    void flush() {
        file_.write(text_);
        text_.clear();
    }
    growing_file file_;
    std::string text_;
};

} // namespace quadrant_cnc
