// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "text.hpp"

#include <nlohmann/json.hpp>

#include <set>
#include <vector>

namespace quadrant::diagnosis::detail {

/// Follows the parser, which itself keeps the last of two equal keys without a word and nests without a limit.
class json_watch {
public:
    explicit json_watch(std::string_view file) : file_(file) {}

    void operator()(nlohmann::json::parse_event_t event, const nlohmann::json& parsed) {
        using on = nlohmann::json::parse_event_t;
        constexpr std::size_t deepest = 32;
        switch (event) {
        case on::object_start:
        case on::array_start:
            if (open_.size() == deepest) throw bad_input(file_, "is nested too deeply");
            open_.emplace_back();
            break;
        case on::key: {
            auto& object = open_.back();
            object.key = parsed.get_ref<const std::string&>();
            if (!object.seen.insert(object.key).second) throw bad_input(file_, path() + ": is there twice");
            break;
        }
        case on::object_end:
        case on::array_end:
            open_.pop_back();
            break;
        case on::value:
            break;
        }
    }

    /// Dotted keys down to the value being read.
    std::string path() const {
        std::string out;
        for (const auto& level : open_)
            if (!level.key.empty()) out += (out.empty() ? "" : ".") + level.key;
        return out;
    }

private:
    struct level_of_nesting {
        std::string key; ///< stays empty in an array
        std::set<std::string> seen;
    };
    std::vector<level_of_nesting> open_;
    std::string_view file_;
};

/// Parses JSON (RFC 8259) or throws bad_input.
inline nlohmann::json parse_json(std::string_view text, std::string_view file) {
    text = without_byte_order_mark(text);
    json_watch watch(file);
    try {
        return nlohmann::json::parse(text,
                                     [&](int, nlohmann::json::parse_event_t event, nlohmann::json& parsed) {
                                         watch(event, parsed);
                                         return true;
                                     });
    } catch (const nlohmann::json::parse_error& fault) {
        const std::size_t last_read = std::min(std::max<std::size_t>(fault.byte, 1) - 1, text.size());
        const std::string_view before = text.substr(0, last_read);
        const auto line = static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n')) + 1;
        const std::size_t column = characters(before.substr(before.find_last_of('\n') + 1)) + 1;
        // "[json.exception...] parse error at line 3, column 5: syntax error while parsing ..."
        const std::string_view what = fault.what();
        const std::size_t place = what.find(": ");
        throw bad_input(file, line, column, what.substr(place == what.npos ? 0 : place + 2));
    } catch (const nlohmann::json::out_of_range&) {
        const std::string path = watch.path();
        throw bad_input(file, path.empty() ? "must be an object" : path + ": must be a finite number");
    }
}

} // namespace quadrant::diagnosis::detail
