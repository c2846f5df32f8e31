#pragma once

#include "scenes/hard_cases/hard_cases.h"
#include "trees/executor.h"

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace boxwood::bench {

/// A case in the numbers that a kernel of floats reads; nothing if rounding changes none. What was
/// known by construction is not known of the rounded case.
std::optional<TrianglePairCase> rounded_to_floats(const TrianglePairCase& c);
std::optional<ObbPairCase> rounded_to_floats(const ObbPairCase& c);
std::optional<FitCase> rounded_to_floats(const FitCase& c);
/// The numbers as they are; [lo, hi] is as much wider as their rounding may move the two, and the
/// case is no longer judged where 0 comes to lie in it.
std::optional<ShapePairCase> rounded_to_floats(const ShapePairCase& c);
double size_of(const ShapeOfPair& of); ///< its greatest length

/// What a library that promises nothing of convex shapes may be off, of the size of both: FCL and
/// Coal, which end at 1e-6, ten times that; in floats twice the 1e-3 at which Bullet ends.
inline double peers_error(const std::string& precision) { return precision == "f32" ? 2e-3 : 1e-5; }

/// Whether all coordinates are finite.
bool is_finite(const TrianglePairCase& c);
bool is_finite(const ObbPairCase& c);
bool is_finite(const ShapePairCase& c); ///< and whether they touch is known
bool is_finite(const FitCase& c);
bool is_finite(const RayCase& c); ///< of the ray: its triangles are looked at by themselves
bool is_finite(const RayBoxCase& c);
bool is_finite(const MotionCase& c);

/// The truths of cases, found by an oracle on several threads when they are first needed, for
/// kernels of either precision. No truth of a case that is not finite.
template <class Case, class Truth> class Truths {
  public:
    using Oracle = std::function<Truth(const Case&)>;
    using List = std::vector<std::optional<Truth>>;

    /// The cases must outlive it.
    Truths(const std::vector<Case>& cases, unsigned threads, Oracle oracle)
        : cases_(cases), threads_(threads), oracle_(std::move(oracle)) {}

    /// precision: f32 or f64, what the kernel reads.
    const List& of(const std::string& precision) {
        if (doubles_.size() != cases_.size())
            doubles_ = found([&](std::size_t i) { return truth_of(cases_[i]); });
        if constexpr (has_floats) {
            if (precision != "f32")
                return doubles_;
            if (floats_.size() != cases_.size())
                floats_ = found([&](std::size_t i) {
                    const auto rounded = rounded_to_floats(cases_[i]);
                    return rounded ? truth_of(*rounded) : doubles_[i];
                });
            return floats_;
        }
        return doubles_;
    }

    /// The case as a kernel of this precision reads it.
    Case as_read(std::size_t i, const std::string& precision) const {
        if constexpr (has_floats)
            if (precision == "f32")
                return rounded_to_floats(cases_[i]).value_or(cases_[i]);
        return cases_[i];
    }

  private:
    static constexpr bool has_floats = requires(const Case& c) { rounded_to_floats(c); };

    std::optional<Truth> truth_of(const Case& c) const {
        return is_finite(c) ? std::optional<Truth>(oracle_(c)) : std::nullopt;
    }

    template <class Find> List found(const Find& find) const {
        List list(cases_.size());
        make_executor("tbb", threads_)->for_each(list.size(), [&](std::size_t i) {
            list[i] = find(i);
        });
        return list;
    }

    const std::vector<Case>& cases_;
    unsigned threads_;
    Oracle oracle_;
    List doubles_, floats_;
};

} // namespace boxwood::bench
