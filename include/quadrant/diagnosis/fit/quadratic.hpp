// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "predictor.hpp"
#include "scoring.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <optional>
#include <vector>

namespace quadrant::diagnosis {

/// Mean squares of the blocks of one channel as quadratics in the step of the parameters: ms + 2 g d + d' A d.
struct block_quadratics {
    Eigen::Index parameters = 0;
    std::vector<double> ms{}, g{}, a{}; ///< block after block

    std::size_t size() const { return ms.size(); }
    Eigen::Map<const Eigen::VectorXd> gradient(std::size_t block) const {
        return {g.data() + static_cast<Eigen::Index>(block) * parameters, parameters};
    }
    Eigen::Map<const Eigen::MatrixXd> curvature(std::size_t block) const {
        return {a.data() + static_cast<Eigen::Index>(block) * parameters * parameters, parameters, parameters};
    }
    double at(std::size_t block, const Eigen::VectorXd& d) const {
        return std::max(0.0, ms[block] + 2 * gradient(block).dot(d) + d.dot(curvature(block) * d));
    }
};

/// A signal of the length of the innovations, and what the channels that average see of it.
struct viewed_signal {
    std::vector<double> rows{};
    std::vector<std::vector<double>> means{}; ///< by channel; empty where it takes every row

    viewed_signal() = default;
    viewed_signal(std::vector<double> all, const scoring& s) : rows(std::move(all)) { look(s); }
    /// Finds the means anew.
    void look(const scoring& s) {
        means.resize(s.channels.size());
        for (std::size_t i = 0; i < means.size(); ++i)
            if (s.channels[i].mean > 1) means[i] = detail::seen(rows, s.channels[i]);
    }
    const double* in(std::size_t channel) const {
        return means[channel].empty() ? rows.data() : means[channel].data();
    }
    /// Mean squares of the blocks of a channel.
    std::vector<double> block_ms(const scoring& s, std::size_t channel) const {
        const auto& c = s.channels[channel];
        return c.mean > 1 ? detail::block_ms(means[channel], 0, c.block / c.mean) : detail::block_ms(rows, c);
    }
};

namespace detail {

/// Mean products of the signals from `from` on with themselves and those before them, by block of a channel:
/// signals.size() numbers a signal.
inline std::vector<double> products(const std::vector<const double*>& signals, std::size_t from,
                                    const channel& c) {
    std::vector<double> out(c.first_of_block.size() * (signals.size() - from) * signals.size());
    passes().products({.signal = signals.data(),
                       .signals = signals.size(),
                       .from = from,
                       .first_of = c.mean == 1 ? c.first_of_block.data() : nullptr,
                       .blocks = c.first_of_block.size(),
                       .rows = c.block / c.mean,
                       .out = out.data()});
    return out;
}

} // namespace detail

/// How the innovations of one model move with each of its parameters, for many fits that begin there; what
/// these slopes make of each block is found once for all of them.
struct shared_slopes {
    std::vector<viewed_signal> of{};             ///< by parameter
    std::vector<std::vector<double>> products{}; ///< by channel, see detail::products

    shared_slopes() = default;
    shared_slopes(std::vector<std::vector<double>> slopes, const scoring& s) {
        for (auto& rows : slopes) of.emplace_back(std::move(rows), s);
        for (std::size_t i = 0; i < s.channels.size(); ++i) {
            std::vector<const double*> signals;
            for (const auto& column : of) signals.push_back(column.in(i));
            products.push_back(detail::products(signals, 0, s.channels[i]));
        }
    }
    double product(std::size_t channel, std::size_t block, std::size_t i, std::size_t j) const {
        const std::size_t n = of.size();
        return products[channel][(block * n + std::max(i, j)) * n + std::min(i, j)];
    }
};

/// Slopes that a fit takes as they are instead of finding them: which of the shared ones each of its first
/// parameters has. The others' slopes are its own.
struct known_slopes {
    const shared_slopes* from = nullptr;
    std::vector<std::size_t> which{};
    std::size_t count() const { return which.size(); }
};

/// The blocks of one channel as quadratics: `e` the innovations, `own` the slopes that are not known. Without
/// `curvature` that of the point before stays.
inline void find_quadratics(block_quadratics& q, const viewed_signal& e, const std::vector<viewed_signal>& own,
                            const known_slopes& known, const channel& c, std::size_t channel, bool curvature) {
    const std::size_t k = known.count(), n = k + own.size(), blocks = c.first_of_block.size(), all = n + 1;
    std::vector<const double*> signals;
    for (const std::size_t i : known.which) signals.push_back(known.from->of[i].in(channel));
    for (const auto& column : own) signals.push_back(column.in(channel));
    signals.push_back(e.in(channel));
    const std::size_t from = curvature ? k : n;
    const auto sums = detail::products(signals, from, c);
    q.parameters = static_cast<Eigen::Index>(n);
    q.ms.resize(blocks);
    q.g.resize(blocks * n);
    if (curvature) q.a.resize(blocks * n * n);
    for (std::size_t b = 0; b < blocks; ++b) {
        const double* const with_e = sums.data() + ((b + 1) * (all - from) - 1) * all;
        q.ms[b] = with_e[n];
        std::copy_n(with_e, n, q.g.data() + b * n);
        if (!curvature) continue;
        double* const a = q.a.data() + b * n * n;
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j <= i; ++j)
                a[i * n + j] = a[j * n + i] =
                    i < k ? known.from->product(channel, b, known.which[i], known.which[j])
                          : sums[(b * (all - from) + i - from) * all + j];
    }
}

} // namespace quadrant::diagnosis
