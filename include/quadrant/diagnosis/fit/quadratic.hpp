// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "predictor.hpp"
#include "scoring.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <memory>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// Mean squares of the blocks of one channel as quadratics in the step of the parameters: ms + 2 g d + d' A d.
/// A is symmetric, and what known slopes make of it is kept once for all fits that know them (shared_slopes):
/// each has the rows of its own slopes only.
struct block_quadratics {
    std::size_t parameters = 0;
    std::vector<double> ms{}, g{};    ///< block after block
    std::vector<double> own{};        ///< of A, to the diagonal
    std::vector<std::size_t> known{}; ///< which of the shared slopes the first parameters have
    std::shared_ptr<const std::vector<double>> products{}; ///< of the shared slopes
    std::size_t shared = 0;                                ///< how many they are

    std::size_t size() const { return ms.size(); }
    /// How many entries a block has in `own`.
    std::size_t own_of_block() const {
        return (parameters * (parameters + 1) - known.size() * (known.size() + 1)) / 2;
    }
    Eigen::Map<const Eigen::VectorXd> gradient(std::size_t block) const {
        return {g.data() + block * parameters, static_cast<Eigen::Index>(parameters)};
    }
    /// A of a block, put together in `into`.
    const Eigen::MatrixXd& curvature(std::size_t block, Eigen::MatrixXd& into) const {
        const auto n = static_cast<Eigen::Index>(parameters);
        into.resize(n, n);
        double* const a = into.data();
        for (std::size_t i = 0; i < known.size(); ++i)
            for (std::size_t j = 0; j <= i; ++j)
                a[i * parameters + j] = a[j * parameters + i] =
                    (*products)[(block * shared + std::max(known[i], known[j])) * shared +
                                std::min(known[i], known[j])];
        const double* row = own.data() + block * own_of_block();
        for (std::size_t i = known.size(); i < parameters; row += ++i)
            for (std::size_t j = 0; j <= i; ++j) a[i * parameters + j] = a[j * parameters + i] = row[j];
        return into;
    }
    double at(std::size_t block, const Eigen::VectorXd& d, Eigen::MatrixXd& scratch) const {
        return std::max(0.0, ms[block] + 2 * gradient(block).dot(d) + d.dot(curvature(block, scratch) * d));
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
    std::vector<viewed_signal> of{};                                    ///< by parameter
    std::vector<std::shared_ptr<const std::vector<double>>> products{}; ///< by channel, see detail::products

    shared_slopes() = default;
    shared_slopes(std::vector<std::vector<double>> slopes, const scoring& s) {
        for (auto& rows : slopes) of.emplace_back(std::move(rows), s);
        for (std::size_t i = 0; i < s.channels.size(); ++i) {
            std::vector<const double*> signals;
            for (const auto& column : of) signals.push_back(column.in(i));
            products.push_back(
                std::make_shared<const std::vector<double>>(detail::products(signals, 0, s.channels[i])));
        }
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
    q.parameters = n;
    q.known = known.which;
    q.shared = known.from ? known.from->of.size() : 0;
    q.products = known.from ? known.from->products[channel] : nullptr;
    q.ms.resize(blocks);
    q.g.resize(blocks * n);
    if (curvature) q.own.resize(blocks * q.own_of_block());
    double* own_row = q.own.data();
    for (std::size_t b = 0; b < blocks; ++b) {
        const double* const with_e = sums.data() + ((b + 1) * (all - from) - 1) * all;
        q.ms[b] = with_e[n];
        std::copy_n(with_e, n, q.g.data() + b * n);
        for (std::size_t i = from; i < n; own_row += ++i)
            std::copy_n(sums.data() + (b * (all - from) + i - from) * all, i + 1, own_row);
    }
}

} // namespace quadrant::inline v0::diagnosis
