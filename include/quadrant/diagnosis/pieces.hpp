// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "candidate.hpp"
#include "record.hpp"

namespace quadrant::diagnosis {

/// A record of one motion, cut into as many pieces as there are folds, of whole blocks: a model is then
/// tested on the piece that it was not fitted to, as it is on a motion of a longer record. Other records stay
/// as they are. `motions`: how many the record holds.
inline axis_record in_pieces(axis_record r, std::size_t& motions) {
    motions = r.segments;
    const std::size_t blocks = r.score.channels.front().segment_of_block.size(), pieces = std::min(folds, blocks);
    if (r.segments > 1 || blocks < 2) return r;
    const auto piece_of = [&](std::size_t block) { return std::min(block, blocks - 1) * pieces / blocks; };
    for (std::size_t k = 0; k < r.segment.size(); ++k)
        r.segment[k] = k < r.score.skip ? 0 : piece_of((k - r.score.skip) / r.score.block);
    for (channel& c : r.score.channels)
        for (std::size_t b = 0; b < c.segment_of_block.size(); ++b)
            c.segment_of_block[b] = r.segment[r.score.skip + b * c.block + c.block / 2];
    r.segments = r.score.segments = pieces;
    return r;
}

} // namespace quadrant::diagnosis
