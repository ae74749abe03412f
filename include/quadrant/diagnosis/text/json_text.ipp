// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// Builds the document itself: the library's own parsers keep the last of two equal keys without a word, nest
/// without a limit and, with a callback, take time by the square of the number of objects.
class json_builder final : public nlohmann::json_sax<nlohmann::json> {
public:
    json_builder(std::string_view text, std::string_view file) : text_(text), file_(file) {}

    nlohmann::json& root() { return root_; }

    bool null() override { return put(nullptr); }
    bool boolean(bool value) override { return put(value); }
    bool number_integer(number_integer_t value) override { return put(value); }
    bool number_unsigned(number_unsigned_t value) override { return put(value); }
    bool number_float(number_float_t value, const string_t&) override { return put(value); }
    bool string(string_t& value) override { return put(std::move(value)); }
    bool binary(binary_t& value) override { return put(std::move(value)); }
    bool start_object(std::size_t) override { return open(nlohmann::json::object()); }
    bool start_array(std::size_t) override { return open(nlohmann::json::array()); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool key(string_t& name) override {
        auto& object = open_.back();
        object.key = std::move(name);
        if (object.value->contains(object.key)) throw bad_input(file_, path() + ": is there twice");
        return true;
    }

    bool parse_error(std::size_t read, const std::string&, const nlohmann::json::exception& fault) override {
        constexpr int number_overflow = 406;
        if (fault.id == number_overflow)
            throw bad_input(file_, open_.empty() ? "must be an object" : path() + ": must be a finite number");
        if (open_.empty() && root_.is_null() && text_.find('{') == text_.npos)
            throw bad_input(file_, "is no JSON: it holds no {; is it another of the files, a log?");
        const std::string_view before = text_.substr(0, read == 0 ? 0 : read - 1);
        const auto line = static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n')) + 1;
        const std::size_t column = characters(before.substr(before.find_last_of('\n') + 1)) + 1;
        // "[json.exception...] parse error at line 3, column 5: syntax error while parsing ..."
        const std::string_view what = fault.what();
        const std::size_t place = what.find(": ");
        throw bad_input(file_, line, column, what.substr(place == what.npos ? 0 : place + 2));
    }

private:
    struct level {
        nlohmann::json* value;
        std::string key{}; ///< the one being read; empty in an array
    };

    /// Dotted keys down to the value being read.
    std::string path() const {
        std::string out;
        for (const auto& outer : open_)
            if (!outer.key.empty()) out += (out.empty() ? "" : ".") + outer.key;
        return out;
    }

    nlohmann::json& joined(nlohmann::json value) {
        if (open_.empty()) return root_ = std::move(value);
        auto& parent = *open_.back().value;
        if (parent.is_object()) return parent[open_.back().key] = std::move(value);
        parent.push_back(std::move(value));
        return parent.back();
    }
    template <class Value> bool put(Value&& value) {
        joined(std::forward<Value>(value));
        return true;
    }
    bool open(nlohmann::json container) {
        constexpr std::size_t deepest = 32;
        if (open_.size() == deepest) throw bad_input(file_, "is nested too deeply");
        auto& opened = joined(std::move(container));
        open_.push_back({&opened});
        return true;
    }
    bool close() {
        open_.pop_back();
        return true;
    }

    nlohmann::json root_;
    std::vector<level> open_;
    std::string_view text_, file_;
};

QUADRANT_DIAGNOSIS_DECL nlohmann::json parse_json(std::string_view text, std::string_view file) {
    text = without_byte_order_mark(text);
    json_builder builder(text, file);
    nlohmann::json::sax_parse(text, &builder);
    return std::move(builder.root());
}

} // namespace quadrant::inline v0::diagnosis::detail
