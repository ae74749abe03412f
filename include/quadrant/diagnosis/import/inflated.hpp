// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <boost/beast/zlib/inflate_stream.hpp>
#include <string>
#include <string_view>

namespace quadrant::inline v0::diagnosis::detail {

/// What a deflate stream held, and how it ended.
struct inflation {
    std::string text;
    std::size_t read = 0; ///< bytes of the stream that were looked at
    bool whole = false;   ///< the stream ended where it says so
    bool beyond = false;  ///< it holds more than was allowed, and was left
};

/// A bare deflate stream, with what stands behind it. At most `most` bytes come out.
inline inflation inflated(std::string_view packed, std::size_t most) {
    inflation out;
    boost::beast::zlib::inflate_stream stream;
    boost::beast::zlib::z_params p;
    boost::beast::error_code fault;
    p.next_in = packed.data();
    p.avail_in = packed.size();
    constexpr std::size_t piece = 1 << 18;
    while (!fault && !out.beyond) {
        out.text.resize(p.total_out + piece);
        p.next_out = out.text.data() + p.total_out;
        p.avail_out = piece;
        const std::size_t before = p.total_out;
        stream.write(p, boost::beast::zlib::Flush::none, fault);
        if (!fault && p.total_out == before) break;
        out.beyond = p.total_out > most;
    }
    out.text.resize(p.total_out);
    out.read = p.total_in;
    out.whole = fault == boost::beast::zlib::error::end_of_stream;
    return out;
}

} // namespace quadrant::inline v0::diagnosis::detail
