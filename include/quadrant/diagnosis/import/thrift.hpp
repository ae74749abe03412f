// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../text/bad_input.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// A structure in Thrift's compact protocol: fields by number. What Parquet writes its footer and page headers
/// in.
class thrift_struct {
public:
    thrift_struct(std::string_view bytes, std::string_view file, int depth = 0)
        : bytes_(bytes), file_(file), depth_(depth) {
        constexpr int deepest = 32;
        if (depth > deepest) refuse();
        int id = 0;
        for (;;) {
            const unsigned head = next();
            if (head == 0) return;
            const unsigned kind = head & 0x0f;
            id = (head >> 4) != 0 ? id + static_cast<int>(head >> 4) : static_cast<int>(zigzag());
            fields_[id] = value(kind);
        }
    }

    /// That the structure takes of the bytes.
    std::size_t bytes() const { return at_; }
    bool has(int id) const { return fields_.count(id) > 0; }
    std::int64_t integer(int id, std::int64_t otherwise) const {
        const auto found = fields_.find(id);
        return found == fields_.end() ? otherwise : found->second.number;
    }
    bool flag(int id, bool otherwise) const { return integer(id, otherwise ? 1 : 0) != 0; }
    std::string_view text(int id) const {
        const auto found = fields_.find(id);
        return found == fields_.end() ? std::string_view() : found->second.text;
    }
    std::vector<thrift_struct> structs(int id) const {
        const auto found = fields_.find(id);
        return found == fields_.end() ? std::vector<thrift_struct>{} : found->second.structs;
    }
    /// A structure in a field; and one in a field of that.
    std::optional<thrift_struct> inner(int id) const {
        const auto found = fields_.find(id);
        if (found == fields_.end() || found->second.structs.empty()) return std::nullopt;
        return found->second.structs.front();
    }
    std::optional<thrift_struct> inner(int id, int in_it) const {
        const auto outer = inner(id);
        return outer ? outer->inner(in_it) : std::nullopt;
    }

private:
    enum type { yes = 1, no, byte, i16, i32, i64, of_double, binary, list, set, map, structure };
    struct field {
        std::int64_t number = 0;
        std::string_view text{};
        std::vector<thrift_struct> structs{};
    };

    [[noreturn]] void refuse() const { throw bad_input(file_, "its description (Thrift) is damaged"); }
    unsigned next() {
        if (at_ >= bytes_.size()) refuse();
        return static_cast<unsigned char>(bytes_[at_++]);
    }
    std::uint64_t varint() {
        std::uint64_t out = 0;
        for (unsigned shift = 0; shift < 64; shift += 7) {
            const unsigned b = next();
            out |= static_cast<std::uint64_t>(b & 0x7f) << shift;
            if (b < 0x80) return out;
        }
        refuse();
    }
    std::int64_t zigzag() {
        const std::uint64_t n = varint();
        return static_cast<std::int64_t>(n >> 1) ^ -static_cast<std::int64_t>(n & 1);
    }
    std::string_view take(std::uint64_t size) {
        if (size > bytes_.size() - at_) refuse();
        const auto out = bytes_.substr(at_, static_cast<std::size_t>(size));
        at_ += static_cast<std::size_t>(size);
        return out;
    }
    field value(unsigned of) {
        field out;
        switch (of) {
        case yes:
        case no:
            out.number = of == yes ? 1 : 0;
            break;
        case byte:
            out.number = next();
            if (out.number > 127) out.number -= 256;
            break;
        case i16:
        case i32:
        case i64:
            out.number = zigzag();
            break;
        case of_double:
            take(8);
            break;
        case binary:
            out.text = take(varint());
            break;
        case list:
        case set: {
            const unsigned head = next(), of_each = head & 0x0f;
            const std::uint64_t count = (head >> 4) == 15 ? varint() : head >> 4;
            if (count > bytes_.size() - at_) refuse();
            for (std::uint64_t k = 0; k < count; ++k) {
                if (of_each == yes || of_each == no) {
                    next();
                    continue;
                }
                field each = value(of_each);
                if (of_each == structure) out.structs.push_back(std::move(each.structs.front()));
            }
            break;
        }
        case map: {
            const std::uint64_t count = varint();
            if (count == 0) break;
            const unsigned types = next();
            if (count > bytes_.size() - at_) refuse();
            for (std::uint64_t k = 0; k < count; ++k) value(types >> 4), value(types & 0x0f);
            break;
        }
        case structure: {
            thrift_struct inside(bytes_.substr(at_), file_, depth_ + 1);
            at_ += inside.bytes();
            out.structs.push_back(std::move(inside));
            break;
        }
        default:
            refuse();
        }
        return out;
    }

    std::string_view bytes_, file_;
    std::size_t at_ = 0;
    int depth_;
    std::map<int, field> fields_{};
};

} // namespace quadrant::inline v0::diagnosis::detail
