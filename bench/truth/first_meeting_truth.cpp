#include "bench/truth/first_meeting_truth.h"

#include "bench/tasks/detail/mesh_pair_answers.h"
#include "bench/truth/posed_triangles.h"
#include "kernels/primitives/rotation.h"
#include "trees/executor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace boxwood::bench {
namespace {

using Pose = RigidTransform<double>;
using Vec = Vec3<double>;

/// How far an end may be from the pose that it is to be, in parts of the greatest coordinate.
constexpr double arrival = 1e-9;

Vec turned(const Rotation& r, const Vec& v) { return {dot(r[0], v), dot(r[1], v), dot(r[2], v)}; }

Rotation transposed(const Rotation& r) {
    return {{{r[0].x, r[1].x, r[2].x}, {r[0].y, r[1].y, r[2].y}, {r[0].z, r[1].z, r[2].z}}};
}

/// With c its cosine and s its sine, R = c I + (1 - c) a a^T + s [a]: the skew part gives s a, the
/// trace c. Beyond two radians, where s may vanish, the axis is taken from a a^T.
struct Turn {
    Vec axis{0, 0, 1};
    double angle = 0;

    explicit Turn(const Rotation& r) {
        const Vec skew = .5 * Vec{r[2].y - r[1].z, r[0].z - r[2].x, r[1].x - r[0].y};
        const double c = (r[0].x + r[1].y + r[2].z - 1) / 2, s = length(skew);
        angle = std::atan2(s, c);
        if (angle > 2) {
            int k = 0;
            for (int i = 1; i < 3; ++i)
                if (entry(r, i, i) > entry(r, k, k))
                    k = i;
            Vec a;
            for (int i = 0; i < 3; ++i)
                a[i] = (entry(r, i, k) + entry(r, k, i)) / 2 - (i == k ? c : 0);
            axis = (dot(a, skew) < 0 ? -1 : 1) / length(a) * a;
        } else if (s > 0) {
            axis = 1 / s * skew;
        }
    }

  private:
    static double entry(const Rotation& r, int i, int j) {
        return r[static_cast<std::size_t>(i)][j];
    }
};

/// A copy's way from one pose to another, by the place of the axis: through `place`, along which
/// the copy turns and, of a linear motion, through which the body's own origin goes.
class Way {
  public:
    Way(const Pose& from, const Pose& to, bool is_screw)
        : from_(from), turn_(product(to.rotation, transposed(from.rotation))) {
        const Vec apart = to.translation - from.translation;
        if (is_screw && turn_.angle > 1e-6) {
            slide_ = dot(apart, turn_.axis) * turn_.axis;
            const Vec across = apart - slide_;
            place_ = from.translation +
                     .5 * (across + 1 / std::tan(turn_.angle / 2) * cross(turn_.axis, across));
        } else {
            slide_ = apart;
            place_ = from.translation;
        }
        const Pose end = at(1);
        double off = length(end.translation - to.translation);
        for (std::size_t i = 0; i < 3; ++i)
            off = std::max(off, length(end.rotation[i] - to.rotation[i]));
        if (!(off <= arrival * (1 + length(from.translation) + length(to.translation))))
            throw std::logic_error(
                fmt::format("the truth's motion ends {} off the pose it is to reach", off));
    }

    Pose at(double t) const {
        const Rotation r = rotation_about(turn_.axis, t * turn_.angle);
        return {product(r, from_.rotation),
                place_ + turned(r, from_.translation - place_) + t * slide_};
    }

    /// No point of these triangles, which stand in the copy's frame, moves faster per unit of t.
    double greatest_speed(const PosedTriangles& copy) const {
        double lever = 0;
        for (const Triangle<double>& t : copy)
            for (const Vec p : {t.a, t.b, t.c})
                lever = std::max(lever, length(cross(turn_.axis, from_(p) - place_)));
        return (turn_.angle * lever + length(slide_)) * (1 + 1e-9);
    }

  private:
    Pose from_;
    Turn turn_;
    Vec slide_{}, place_{};
};

/// The mesh and its copy on one of its ways.
class Motions {
  public:
    explicit Motions(const Scene& scene)
        : scene_(scene), copy_(triangles_at(scene.copy(), {})),
          still_(triangles_at(scene.mesh, {})), copy_at_rest_(copy_) {
        for (std::size_t i = 0; i < scene.poses.size(); ++i)
            ways_.emplace_back(scene.poses[i], scene.poses[next_pose(i, scene.poses.size())],
                               scene.spec.motion == "screw");
    }

    std::size_t size() const { return ways_.size(); }
    NearestTriangles::Least least(std::size_t i, double t) const {
        NearestTriangles copy = copy_at_rest_;
        copy.move(triangles_at(scene_.copy(), ways_[i].at(t)));
        return still_.to(copy);
    }
    double greatest_speed(std::size_t i) const { return ways_[i].greatest_speed(copy_); }

  private:
    const Scene& scene_;
    PosedTriangles copy_;
    NearestTriangles still_, copy_at_rest_;
    std::vector<Way> ways_;
};

class FirstMeetingTruth final : public Truth {
  public:
    FirstMeetingTruth(const Scene& scene, unsigned threads)
        : motions_(scene), tolerance_(meeting_tolerance(scene.mesh)), threads_(threads),
          free_until_(motions_.size()) {
        for_each_motion([&](std::size_t i) { free_until_[i] = sampled(i); });
    }

    Judgement judge(const Answers& answers, const ContenderEntry&) override {
        const std::vector<FirstMeeting>& got = list_of<FirstMeeting>(answers);
        Judgement judgement;
        results::Check& check = judgement.check;
        check.oracle = "rational";
        check.n_checked = check.n_expected = motions_.size();
        check.n_got = got.size();
        if (got.size() != motions_.size()) {
            check.missing = motions_.size();
            check.witness = fmt::format("{} answers for {} motions", got.size(), motions_.size());
            judgement.conclude(false);
            return judgement;
        }
        std::vector<Fault> faults(got.size());
        for_each_motion([&](std::size_t i) { faults[i] = fault_of(i, got[i]); });
        for (std::size_t i = 0; i < faults.size(); ++i) {
            if (faults[i].what.empty())
                continue;
            ++(faults[i].is_missed ? check.missing : check.extra);
            if (check.witness.empty())
                check.witness = fmt::format("motion {}: {}", i, faults[i].what);
        }
        judgement.conclude(false);
        return judgement;
    }

  private:
    struct Fault {
        bool is_missed = false; ///< a contact is
        std::string what;
    };

    template <class F> void for_each_motion(const F& f) {
        make_executor("tbb", threads_)->for_each(motions_.size(), f);
    }

    /// Up to when it is certain that they do not touch: 1, or where they are nearer than half the
    /// tolerance.
    double sampled(std::size_t i) const {
        const double speed = motions_.greatest_speed(i);
        double t = 0;
        for (int step = 0; step < 10'000 && t < 1; ++step) {
            const auto [distance, lo] = motions_.least(i, t);
            if (distance <= tolerance_ / 2)
                break;
            t = speed > 0 ? std::min(1.0, t + lo / speed) : 1;
        }
        return t;
    }

    /// A time before `end`, or then if that is 1, at which they touch, if a sample shows one: half
    /// of them close to where they are near each other.
    std::optional<double> touch_before(std::size_t i, double end) const {
        const double begin = free_until_[i];
        const auto touches = [&](double t) { return motions_.least(i, t).distance == 0; };
        for (int k = 1; k <= 20; ++k)
            for (const double part : {k / 20., std::ldexp(1, -k)}) {
                const double t = begin + part * (end - begin);
                if ((t < end || end == 1) && touches(t))
                    return t;
            }
        return std::nullopt;
    }

    Fault fault_of(std::size_t i, const FirstMeeting& got) const {
        if (!(got.t_free >= 0 && got.t_free <= got.t_hit && got.t_hit <= 1))
            return {false, fmt::format("[{}, {}] are no times", got.t_free, got.t_hit)};
        if (got.meets == Meets::no && got.t_free < 1)
            return {false, fmt::format("said never to meet, but free only until {}", got.t_free)};
        if (got.meets == Meets::yes)
            if (const double apart = motions_.least(i, got.t_hit).distance; apart > 8 * tolerance_)
                return {false, fmt::format("said to meet at {}, where they are {} apart", got.t_hit,
                                           apart)};
        // Else nothing would have to be found out.
        const bool is_known_there = got.meets == Meets::yes && got.t_free == got.t_hit;
        if (got.meets != Meets::no && got.t_free < 1 && !is_known_there)
            if (const double apart = motions_.least(i, got.t_free).distance; apart > 8 * tolerance_)
                return {false,
                        fmt::format("said to be free until {} alone, where they are {} apart",
                                    got.t_free, apart)};
        if (got.t_free > free_until_[i])
            if (const auto t = touch_before(i, got.t_free))
                return {true, fmt::format("said to be free until {}, and at {} they touch",
                                          got.t_free, *t)};
        return {};
    }

    Motions motions_;
    double tolerance_;
    unsigned threads_;
    std::vector<double> free_until_; ///< by motion
};

} // namespace

double meeting_tolerance(const TriangleMesh& mesh) {
    Aabb<double> box;
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t vertex : triangle)
            box.extend(Vec3<double>(mesh.vertices[vertex]));
    return mesh.triangles.empty() ? 0 : 1e-5 * length(box.max - box.min);
}

std::unique_ptr<Truth> make_first_meeting_truth(const Scene& scene, unsigned threads) {
    return std::make_unique<FirstMeetingTruth>(scene, threads);
}

} // namespace boxwood::bench
