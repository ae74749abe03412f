// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../page/progress.hpp"
#include "page.hpp"
#include "pool.hpp"

#include <cstdio>
#include <deque>
#include <numeric>

/// What is done, what is to do, and how long it takes.
namespace quadrant_gap::fleet {

class work_list {
public:
    work_list(std::vector<entry> entries, fs::path out, const std::string& program_sha256, bool retry)
        : entries_(std::move(entries)), out_(std::move(out)), rows_(entries_.size()) {
        for (std::size_t k = 0; k < entries_.size(); ++k) {
            const state s = state_of(out_, entries_[k], program_sha256);
            rows_[k].name = entries_[k].name;
            if (s == state::missing || (s == state::failed && retry)) {
                to_do_.push_back(k);
            } else {
                rows_[k] = row_of_files(k);
                ++(s == state::done ? done_before_ : failed_before_);
            }
        }
        // The longest first, so that none of them runs alone at the end.
        std::stable_sort(to_do_.begin(), to_do_.end(),
                         [&](std::size_t a, std::size_t b) { return entries_[a].bytes > entries_[b].bytes; });
        left_ = to_do_.size();
        for (const std::size_t k : to_do_) bytes_left_ += bytes_of(k);
    }

    const entry& at(std::size_t k) const { return entries_.at(k); }
    const std::vector<row>& rows() const { return rows_; }
    const std::deque<std::size_t>& to_do() const { return to_do_; }
    std::size_t left() const { return left_; }
    std::size_t failed_before() const { return failed_before_; }
    std::size_t done_before() const { return done_before_; }
    std::size_t next() {
        const std::size_t k = to_do_.front();
        to_do_.pop_front();
        return k;
    }
    void ended(const outcome& o) {
        rows_.at(o.index) =
            o.error.empty() ? row_of_files(o.index) : failed_row(entries_.at(o.index).name, o.error);
        --left_;
        ++(o.error.empty() ? done_ : failed_);
        bytes_left_ -= bytes_of(o.index);
        bytes_done_ += bytes_of(o.index);
    }
    std::string progress(double seconds) const {
        std::string text = fmt::format("{:.0f} %: {} done, {} failed, {} left",
                                       left_ == 0 ? 100 : 100 * bytes_done_ / (bytes_done_ + bytes_left_),
                                       done_before_ + done_, failed_before_ + failed_, left_);
        if (bytes_done_ > 0 && left_ > 0)
            text += ", about " + quadrant_page::about(seconds * bytes_left_ / bytes_done_);
        return text;
    }

private:
    double bytes_of(std::size_t k) const { return 1 + static_cast<double>(entries_.at(k).bytes); }
    row row_of_files(std::size_t k) const {
        const result_files files(out_, entries_.at(k).name);
        const ordered_json error = read_json(files.error), found = read_json(files.diagnosis);
        std::error_code ignored;
        if (fs::exists(files.done, ignored) && found.is_object()) return row_of(entries_.at(k).name, found);
        return failed_row(entries_.at(k).name, error.is_object() ? error.value("error", "") : "");
    }

    std::vector<entry> entries_;
    fs::path out_;
    std::vector<row> rows_;
    std::deque<std::size_t> to_do_;
    std::size_t left_ = 0, done_before_ = 0, failed_before_ = 0, done_ = 0, failed_ = 0;
    double bytes_left_ = 0, bytes_done_ = 0;
};

} // namespace quadrant_gap::fleet
