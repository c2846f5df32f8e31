#include "kernels/continuous/tight_inclusion.h"

#include "kernels/arithmetic/float_mode.h"
#include "kernels/continuous/detail/inclusion.h"
#include "kernels/continuous/detail/nearest_direction.h"
#include "kernels/continuous/detail/touch_proof.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>

namespace boxwood {
namespace {

using namespace detail::inclusion;
using Vector = Vec3<double>;

/// A patch and the time before which no touch is on it.
template <int n> struct Piece {
    double time;
    int depth; ///< number of halvings
    Patch<n> patch;

    static bool later(const Piece& a, const Piece& b) { return a.time > b.time; }
};

template <int n> class Search {
  public:
    Search(const TightInclusion& settings, const LinearMotion& motion, std::uint64_t bits)
        : settings_(settings), f_(motion, bits), separation_(f_.scaled(settings.separation)),
          tolerance_(settings.tolerance * f_.size) {}

    Impact run() {
        if (apart_on_an_axis())
            return {};
        push({0, 0, Patch<n>::whole()});
        while (size_ > 0) {
            const Outcome outcome = advance(pop());
            if (outcome != Outcome::go_on)
                return conclude(outcome);
        }
        return {.tier = tier_};
    }

  private:
    enum class Outcome { go_on, near, limit };

    /// Pieces at a time. A search 48 halvings deep needs at most 49 while it goes straight for one
    /// place; beyond the capacity pieces are advanced but not halved.
    static constexpr std::size_t capacity = 256;
    static constexpr int max_halvings = 48;
    /// A step is poor if it covers less than this part of what the nearest point itself allows.
    static constexpr double good_part = 2.0 / 3;

    struct Corners {
        std::array<Vector, n> start, end;
    };
    /// d.F at the corners: beyond `margin` from `from` until `until`.
    struct Plane {
        std::array<double, n> start, end;
        double margin;  ///< of rounding, and the separation
        double landing; ///< where a step ends, so that it is still beyond the margin
        double until;
    };

    bool apart_on_an_axis() const {
        constexpr Patch<n> all = Patch<n>::whole();
        Vector low = f_.start.at(all.u[0], all.v[0]), high = low;
        for (const auto* side : {&f_.start, &f_.end})
            for (std::size_t i = 0; i < n; ++i) {
                const Vector value = side->at(all.u[i], all.v[i]);
                low = min(low, value);
                high = max(high, value);
            }
        for (int axis = 0; axis < 3; ++axis) {
            const double margin = f_.bound[axis] + f_.min_error + separation_;
            if (low[axis] > margin || high[axis] < -margin)
                return true;
        }
        return false;
    }

    /// Whether the plane through the origin across d has F on its positive side at time `from`,
    /// and until when.
    bool separates(const Corners& corners, Vector d, double from, Plane& plane) const {
        const double rounding = f_.margin(d);
        plane.margin = rounding + separation_ * length(d) * (1 + 0x1p-50);
        plane.landing = plane.margin + rounding;
        bool positive = true;
        for (std::size_t i = 0; i < n; ++i) {
            plane.start[i] = dot(d, corners.start[i]);
            plane.end[i] = dot(d, corners.end[i]);
            positive = positive && mean(plane.start[i], plane.end[i], from) > plane.margin;
        }
        if (!positive)
            return false;
        // At each corner the value is linear in t: beyond the margin at both ends of a step is
        // beyond it all along. The step ends where the first one comes down to the landing.
        plane.until = 1;
        for (std::size_t i = 0; i < n; ++i)
            if (!(plane.end[i] > plane.margin))
                plane.until =
                    std::min(plane.until, falls_to(plane.landing, plane.start[i], plane.end[i]));
        for (std::size_t i = 0; i < n; ++i)
            positive = positive && mean(plane.start[i], plane.end[i], plane.until) > plane.margin;
        return positive && plane.until > from;
    }
    static double falls_to(double value, double start, double end) {
        return (start - value) / (start - end);
    }

    /// Moves a piece on in time until it is done, is not the earliest any more, or is halved.
    Outcome advance(Piece<n> piece) {
        Corners corners;
        for (std::size_t i = 0; i < n; ++i) {
            corners.start[i] = f_.start.at(piece.patch.u[i], piece.patch.v[i]);
            corners.end[i] = f_.end.at(piece.patch.u[i], piece.patch.v[i]);
        }
        const double others = size_ > 0 ? pieces_[0].time : 1;
        while (piece.time <= others) {
            time_ = piece.time;
            if (out_of_limits())
                return Outcome::limit;
            std::array<Vector, n> now;
            for (std::size_t i = 0; i < n; ++i)
                now[i] = mean(corners.start[i], corners.end[i], piece.time);
            const Nearest<n> nearest = nearest_to_origin<n>(now);
            Plane plane;
            const bool separated =
                separates(corners, nearest.direction, piece.time, plane) ||
                separates(corners, normalised(nearest.normal), piece.time, plane);
            if (separated) {
                if (plane.until >= 1)
                    return Outcome::go_on;
                piece.time = plane.until;
                if (piece.time - time_ >= good_part * (until_of(nearest, plane) - time_))
                    continue;
            }
            const double beyond = nearest.distance - separation_;
            const bool is_near = beyond <= tolerance_ || beyond <= 4 * f_.margin(nearest.direction);
            if (is_near || piece.depth == max_halvings) {
                note_touch(piece.patch, nearest);
                return Outcome::near;
            }
            if (size_ + 2 > capacity) {
                if (separated)
                    continue;
                return Outcome::limit;
            }
            halve(piece, now);
            return Outcome::go_on;
        }
        push(piece);
        return Outcome::go_on;
    }

    /// Until when the plane stays clear of the nearest point itself.
    static double until_of(const Nearest<n>& nearest, const Plane& plane) {
        double start = 0, end = 0;
        for (std::size_t i = 0; i < n; ++i) {
            start += nearest.weights[i] * plane.start[i];
            end += nearest.weights[i] * plane.end[i];
        }
        return end > plane.margin ? 1 : std::clamp(falls_to(plane.landing, start, end), 0.0, 1.0);
    }

    /// Across the longest side, as it is now.
    void halve(Piece<n> piece, const std::array<Vector, n>& now) {
        int edge = 0;
        double max_width = -1;
        for (int i = 0; i < (n == 3 ? 3 : 2); ++i) {
            const auto c = static_cast<std::size_t>(i);
            const Vector side = now[(c + 1) % n] - now[c];
            if (const double length2 = dot(side, side); length2 > max_width) {
                max_width = length2;
                edge = i;
            }
        }
        ++piece.depth;
        Piece<n> other = piece;
        other.patch = piece.patch.halve(edge);
        push(piece);
        push(other);
        tier_ = 2;
    }

    void note_touch(const Patch<n>& patch, const Nearest<n>& nearest) {
        near_ = {time_, 0, 0};
        for (std::size_t i = 0; i < n; ++i) {
            near_.u += nearest.weights[i] * patch.u[i];
            near_.v += nearest.weights[i] * patch.v[i];
        }
    }

    Impact conclude(Outcome outcome) const {
        if (outcome == Outcome::limit)
            return {Answer::maybe, time_, 1, 3};
        if (const auto hit = separation_ > 0 ? std::nullopt : proven_touch(f_, near_))
            return {Answer::yes, time_, *hit, tier_};
        return {Answer::maybe, time_, 1, tier_};
    }

    bool out_of_limits() {
        if (checks_++ >= settings_.max_checks)
            return true;
        if (settings_.time_limit_s == std::numeric_limits<double>::infinity() || checks_ % 64 != 1)
            return false;
        const auto now = std::chrono::steady_clock::now();
        if (checks_ == 1)
            began_ = now;
        return std::chrono::duration<double>(now - began_).count() >= settings_.time_limit_s;
    }

    void push(const Piece<n>& piece) {
        pieces_[size_++] = piece;
        std::push_heap(pieces_.begin(), end(), Piece<n>::later);
    }
    Piece<n> pop() {
        std::pop_heap(pieces_.begin(), end(), Piece<n>::later);
        return pieces_[--size_];
    }
    auto end() { return pieces_.begin() + static_cast<std::ptrdiff_t>(size_); }

    const TightInclusion& settings_;
    const Inclusion<n> f_;
    const double separation_, tolerance_;
    std::array<Piece<n>, capacity> pieces_; ///< a heap, the earliest in front
    std::size_t size_ = 0, checks_ = 0;
    double time_ = 0; ///< no touch before it
    Parameters near_{};
    std::uint8_t tier_ = 1;
    std::chrono::steady_clock::time_point began_;
};

/// Whether the boxes around the paths of two sets of points are farther apart than `separation`:
/// differences are rounded, which keeps their order.
template <int n> bool paths_apart(const LinearMotion& motion, double separation) {
    constexpr std::size_t first = n == 3 ? 1 : 2; // points of the first feature
    Vector low[2], high[2];
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t side = i < first ? 0 : 1;
        const Vector from = min(motion.start[i], motion.end[i]);
        const Vector to = max(motion.start[i], motion.end[i]);
        const bool is_new = i == 0 || i == first;
        low[side] = is_new ? from : min(low[side], from);
        high[side] = is_new ? to : max(high[side], to);
    }
    const Vector gap = max(low[0] - high[1], low[1] - high[0]);
    return gap.x > separation || gap.y > separation || gap.z > separation;
}

template <int n> Impact solve(const TightInclusion& settings, const LinearMotion& motion) {
    const std::uint64_t bits = largest_bits(motion);
    if (bits >= std::bit_cast<std::uint64_t>(std::numeric_limits<double>::infinity()))
        return {Answer::maybe, 0, 1, 0};
    return without_flushing([&]() -> Impact {
        if (paths_apart<n>(motion, settings.separation))
            return {};
        return Search<n>(settings, motion, bits).run();
    });
}

} // namespace

Impact TightInclusion::vertex_face(const LinearMotion& motion) const {
    return solve<3>(*this, motion);
}
Impact TightInclusion::edge_edge(const LinearMotion& motion) const {
    return solve<4>(*this, motion);
}

} // namespace boxwood
