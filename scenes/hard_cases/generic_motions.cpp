#include "scenes/hard_cases/lattice.h"
#include "scenes/hard_cases/rounded.h"

namespace boxwood {
namespace {

using Vec = Vec3<double>;
using Four = std::array<Vec, 4>;

/// Positions at t = 0 and t = 1 before they are turned.
struct Moves {
    Four start, end;
    Known touch;
};

/// Of those that pass through `at` at time t with these velocities.
Moves moves_through(const Four& at, const Four& velocity, double t) {
    Moves m{{}, {}, Known::yes};
    for (std::size_t p = 0; p < 4; ++p) {
        m.start[p] = at[p] - t * velocity[p];
        m.end[p] = at[p] + (1 - t) * velocity[p];
    }
    return m;
}

/// y >= 1/16 for the points of one, y <= -1/16 for those of the other, at the start and the end.
Moves apart(Draws& draws, const std::array<bool, 4>& upper) {
    Moves m{{}, {}, Known::no};
    for (Four* points : {&m.start, &m.end})
        for (std::size_t p = 0; p < 4; ++p) {
            Vec& point = (*points)[p];
            point = draw_offset(draws);
            const double height = draws.uniform(0.0625, 1);
            point.y = upper[p] ? height : -height;
        }
    return m;
}

double draw_speed(Draws& draws) {
    const double speed = draws.uniform(0.5, 1);
    return draw_coin(draws) ? speed : -speed;
}

/// How far a touch lies beside the feature, or outside the step: before its start if below 0, else
/// after its end.
struct Missed {
    double beside = 0, time = 0;
};

/// From 1/16 to 15/16, if it is not missed.
double draw_time(Draws& draws, const Missed& missed) {
    const double t = draws.uniform(0.0625, 0.9375);
    return missed.time < 0 ? missed.time : missed.time > 0 ? 1 + missed.time : t;
}

/// The vertex passes through the inside of the face, if it does not miss, along its normal at a
/// relative speed of 1/2 or more: no rounding undoes that.
Moves through_face(Draws& draws, const Missed& missed) {
    Triangle<double> face;
    Vec n;
    do {
        face = draw_triangle(draws);
        n = normal_of(face);
    } while (dot(n, n) < 0.0625);
    double u = draws.uniform(0.125, 0.375);
    const double v = draws.uniform(0.125, 0.375);
    if (missed.beside > 0)
        u = -missed.beside;
    Four velocity{Vec{}, draw_offset(draws), draw_offset(draws), draw_offset(draws)};
    const Vec face_velocity =
        point_of(Triangle<double>{velocity[1], velocity[2], velocity[3]}, u, v);
    const double speed = draw_speed(draws);
    velocity[0] = face_velocity + (speed / length(n)) * n + 0.25 * cross(n, draws.in_ball());
    return moves_through({point_of(face, u, v), face.a, face.b, face.c}, velocity,
                         draw_time(draws, missed));
}

/// The same of two edges; one that misses begins beyond where their lines cross.
Moves across_edge(Draws& draws, const Missed& missed) {
    Vec d, e, n;
    do {
        d = draws.unit_vector();
        e = draws.unit_vector();
        n = cross(d, e);
    } while (dot(n, n) < 0.0625);
    double reach[4] = {draws.uniform(0.25, 1), draws.uniform(0.25, 1), draws.uniform(0.25, 1),
                       draws.uniform(0.25, 1)};
    if (missed.beside > 0)
        reach[0] = -missed.beside;
    const Vec through = draws.in_ball();
    const Four at{through - reach[0] * d, through + reach[1] * d, through - reach[2] * e,
                  through + reach[3] * e};
    const Vec v = draw_offset(draws), turn_d = draw_offset(draws), turn_e = draw_offset(draws);
    const double speed = draw_speed(draws);
    const Vec w = v + (speed / length(n)) * n;
    // Each edge turns about the point where it crosses the other.
    const Four velocity{v - reach[0] * turn_d, v + reach[1] * turn_d, w - reach[2] * turn_e,
                        w + reach[3] * turn_e};
    return moves_through(at, velocity, draw_time(draws, missed));
}

Moves vertex_face(Draws& draws, int) {
    if (draw_coin(draws))
        return apart(draws, {true, false, false, false});
    return through_face(draws, {});
}

Moves edge_edge(Draws& draws, int) {
    if (draw_coin(draws))
        return apart(draws, {false, false, true, true});
    return across_edge(draws, {});
}

/// By 10^-4 to 10^-k, before the start, after the end, or beside the feature.
template <Moves (*draw)(Draws&, const Missed&)> Moves just_missed(Draws& draws, int k) {
    const double by = draw_small(draws, static_cast<int>(draw_integer(draws, 4, k)));
    Missed missed;
    (draw_coin(draws) ? missed.beside : missed.time) = by;
    if (draw_coin(draws))
        missed.time = -missed.time;
    Moves m = draw(draws, missed);
    m.touch = Known::unknown;
    return m;
}

template <Moves (*draw)(Draws&, int), MotionKind kind>
Cases motions(const HardCaseSpec& spec, const Random& random) {
    MotionCases cases{kind, std::vector<MotionCase>(spec.n)};
    for (std::size_t i = 0; i < spec.n; ++i) {
        Draws draws = random.item(i);
        const Moves m = draw(draws, spec.k.value_or(0));
        const RigidTransform<double> turn = draw_rotation(draws);
        for (std::size_t p = 0; p < 4; ++p) {
            cases.motions[i].motion.start[p] = scaled(turn(m.start[p]), spec.scale);
            cases.motions[i].motion.end[p] = scaled(turn(m.end[p]), spec.scale);
        }
        cases.motions[i].touch = m.touch;
    }
    return cases;
}

} // namespace

HardCaseFamily generic_vertex_face_family() {
    return rounded_family("generic_vertex_face",
                          "a vertex through the inside of a face, or kept away from it",
                          Panel::generic, motions<vertex_face, MotionKind::vertex_face>);
}

HardCaseFamily generic_edge_edge_family() {
    return rounded_family("generic_edge_edge", "an edge across another, or kept away from it",
                          Panel::generic, motions<edge_edge, MotionKind::edge_edge>);
}

HardCaseFamily just_missed_vertex_face_family() {
    return with_k(rounded_family("just_missed_vertex_face",
                                 "a vertex through a face just before, after or beside it",
                                 Panel::touching,
                                 motions<just_missed<through_face>, MotionKind::vertex_face>),
                  "missed by 10^-4 to 10^-k", 16, 4, 18);
}

HardCaseFamily just_missed_edge_edge_family() {
    return with_k(rounded_family("just_missed_edge_edge",
                                 "an edge across another just before, after or beside it",
                                 Panel::touching,
                                 motions<just_missed<across_edge>, MotionKind::edge_edge>),
                  "missed by 10^-4 to 10^-k", 16, 4, 18);
}

} // namespace boxwood
