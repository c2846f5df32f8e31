#pragma once

#include "kernels/convex/motion.h"
#include "kernels/convex/signed_distance.h"

namespace boxwood::convex {

/// When two moving shapes first touch. They do not share a point before t_free, proven. no: not
/// until t = 1. yes: at t_hit they share one, proven, so that the first contact is between the two
/// times. maybe: after t_free rounding or the number of steps left it open (they graze, or touch
/// and no more); t_hit is infinite.
struct FirstContact {
    Answer answer = Answer::no;
    double t_free = 1, t_hit = 1;
    int steps = 0;
};

inline constexpr KernelInfo first_contact_info{
    "convex_convex",
    "conservative_advancement",
    "steps by a certified gap over the closing speed along it; screws and lines",
    Promise::certified,
    "no contact before t_free, a contact by t_hit; maybe where they graze",
    "3 to 100 distances"};

/// Conservative advancement (Mirtich 1996; Tang, Kim, Manocha 2009) on certified gaps: the gap
/// along the normal falls no faster than the two move along it, so that no thin plate is passed
/// through. Ends when the shapes are nearer than `slack`, then looks for an overlap close behind.
/// slack: scene units; 0 is 2^-40 of the size of all. Half-spaces and planes must not spin (maybe).
FirstContact first_contact(const Shape& a, const Motion& motion_a, const Shape& b,
                           const Motion& motion_b, double slack = 0);

} // namespace boxwood::convex
