#pragma once

#include "scenes/hard_cases/hard_cases.h"

#include <cstdint>
#include <span>
#include <string>

/// Cases in words: hex floats, comma-separated, as the query commands read them.
namespace boxwood::bench {

std::string text_of(const TrianglePairCase& c); ///< a.a, a.b, a.c, b.a, b.b, b.c
std::string text_of(const Triangle<float>& t);
std::string text_of(std::span<const Vec3<double>> points);
std::string text_of(const RayCase& c);       ///< origin, direction, t_min, t_max
std::string text_of(const RayBoxCase& c);    ///< the ray, box min, box max
std::string text_of(const MotionCase& c);    ///< four start points, four end points
std::string text_of(const ObbPairCase& c);   ///< centre, axes and half sizes of each
std::string text_of(const ShapePairCase& c); ///< of each kind, lengths (of a hull how many points),
                                             ///< rotation, translation; no command reads it
std::string text_of(const FitCase& c);       ///< rotation rows, translation, box min, box max

} // namespace boxwood::bench
