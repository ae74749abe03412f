// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../fit/record.hpp"
#include "candidate.hpp"

namespace quadrant::inline v0::diagnosis {

/// A record of fewer motions than there are folds, cut into as many pieces as folds, of whole blocks: a model
/// is then tested on the piece that it was not fitted to, as it is on a motion of a longer record. To leave one
/// of two motions out would leave half of the record to find the parameters from, and half of a warm-up. Other
/// records stay as they are. `motions`: how many the record holds.
inline axis_record in_pieces(axis_record r, std::size_t& motions) {
    motions = r.segments;
    const auto& first = r.score.channels.front().first_of_block;
    const std::size_t blocks = first.size(), pieces = std::min(folds, blocks);
    if (blocks < 2 || r.segments >= pieces) return r;
    const auto piece_of = [&](std::size_t block) { return std::min(block, blocks - 1) * pieces / blocks; };
    for (std::size_t k = 0, b = 0; k < r.segment.size(); ++k) {
        while (b + 1 < blocks && k >= first[b + 1]) ++b;
        r.segment[k] = piece_of(b);
    }
    for (channel& c : r.score.channels)
        for (std::size_t b = 0; b < c.segment_of_block.size(); ++b)
            c.segment_of_block[b] = r.segment[(c.first_of_block[b] + c.block / 2) % r.segment.size()];
    r.segments = r.score.segments = pieces;
    return r;
}

} // namespace quadrant::inline v0::diagnosis
