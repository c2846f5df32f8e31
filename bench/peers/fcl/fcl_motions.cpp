#include "bench/peers/answering.h"
#include "bench/peers/fcl/mesh_models.h"
#include "bench/peers/mesh_peers.h"
#include "bench/tasks/detail/mesh_pair_answers.h"
#include "bench/truth/first_meeting_truth.h"
#include "trees/world/motion.h"

#include <fcl/math/motion/interp_motion.h>
#include <fcl/math/motion/screw_motion.h>
#include <fcl/math/motion/translation_motion.h>
#include <fcl/narrowphase/continuous_collision.h>

#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace boxwood::bench {
namespace {

/// Not InterpMotion(from, to), which leaves the point unset that goes straight.
std::unique_ptr<fcl::MotionBase<double>> motion_between(const fcl::Transform3d& from,
                                                        const fcl::Transform3d& to, bool is_screw) {
    if (is_screw)
        return std::make_unique<fcl::ScrewMotion<double>>(from, to);
    return std::make_unique<fcl::InterpMotion<double>>(
        from.linear(), from.translation(), to.linear(), to.translation(), fcl::Vector3d::Zero());
}

template <class Volume> class FirstMeetings final : public MeshModels<Volume> {
  public:
    FirstMeetings(const Job& job, fcl::CCDSolverType solver, std::size_t samples)
        : MeshModels<Volume>(job), is_screw_(job.scene->spec.motion == "screw") {
        request_.ccd_solver_type = solver;
        request_.ccd_motion_type = is_screw_ ? fcl::CCDM_SCREW : fcl::CCDM_LINEAR;
        request_.num_max_iterations = samples;
    }
    void query(Answers& answers) override {
        std::vector<FirstMeeting>& meetings = list_of<FirstMeeting>(answers);
        meetings.clear();
        const std::size_t n = this->poses_.size();
        for (std::size_t i = 0; i < n; ++i) {
            const fcl::TranslationMotiond still(fcl::Transform3d::Identity(),
                                                fcl::Transform3d::Identity());
            const auto motion =
                motion_between(this->poses_[i], this->poses_[next_pose(i, n)], is_screw_);
            fcl::ContinuousCollisionResultd result;
            fcl::continuousCollide<double>(this->model_.get(), &still, &this->copy(), motion.get(),
                                           request_, result);
            const double t = result.is_collide ? result.time_of_contact : 1;
            meetings.push_back({t, t, result.is_collide ? Meets::yes : Meets::no});
        }
    }

  private:
    bool is_screw_;
    fcl::ContinuousCollisionRequestd request_;
};

/// Conservative advancement as a user writes it on FCL's distance: no step is longer than the
/// distance takes at the greatest speed, until the two are within the task's tolerance.
template <class Volume> class SteppedMeetings final : public MeshModels<Volume> {
  public:
    using S = typename Volume::S;
    explicit SteppedMeetings(const Job& job)
        : MeshModels<Volume>(job),
          path_(job.scene->spec.motion == "screw" ? MotionPath::screw : MotionPath::linear),
          tolerance_(meeting_tolerance(job.scene->mesh)) {
        const TriangleMesh& copy = job.scene->copy();
        for (std::size_t i = 0; i < copy.triangles.size(); ++i)
            box_.extend(copy.triangle(i).bounds());
    }
    void query(Answers& answers) override {
        std::vector<FirstMeeting>& meetings = list_of<FirstMeeting>(answers);
        meetings.clear();
        const auto& poses = this->scene_.poses;
        for (std::size_t i = 0; i < poses.size(); ++i)
            meetings.push_back(
                meeting_of(boxwood::Motion(poses[i], poses[next_pose(i, poses.size())], path_)));
    }

  private:
    FirstMeeting meeting_of(const boxwood::Motion& motion) {
        const double speed = motion.longest_way(box_);
        double t = 0;
        auto below = std::numeric_limits<S>::max();
        while (t < 1) {
            const auto apart = static_cast<double>(
                this->distance_at(transform_of<S>(motion.at(t)), request_, below).min_distance);
            if (!(apart > tolerance_))
                return {t, t, Meets::yes};
            t = speed > 0 ? t + apart / speed : 1;
            below = static_cast<S>(2.01 * apart); // a step brings no point farther than `apart`
        }
        return {};
    }

    MotionPath path_;
    double tolerance_;
    Aabb<float> box_; ///< of the copy
    fcl::DistanceRequest<S> request_{false};
};

template <class Volume>
ContenderEntry entry_of_motions(const std::string& after, const std::string& how) {
    return entry_of_models<Volume>(
        after, how, "motion after motion, made from its two poses in the query; " + how);
}

template <class Volume> void append_stepped(std::vector<ContenderEntry>& all) {
    ContenderEntry& stepped = all.emplace_back(entry_of_motions<Volume>(
        ".stepped",
        "conservative advancement around its distance, with our motions and their bound of the "
        "speed, as continuousCollide errs; each distance starts at twice the one before, which a "
        "step cannot pass; until nearer than 1e-5 of the mesh's diagonal"));
    stepped.answers = {answering<SteppedMeetings<Volume>>("continuous")};
}

/// In doubles alone, as its answers are wrong.
template <class Volume> void append_continuous(std::vector<ContenderEntry>& all) {
    ContenderEntry& continuous = all.emplace_back(entry_of_motions<Volume>(
        ".continuous",
        "continuousCollide by conservative advancement, which ends where a step is 1e-5 of the "
        "motion: that is fixed, toc_err and num_max_iterations are not read; it passes through "
        "meshes, and meets them where they are not"));
    continuous.answers = {answering<FirstMeetings<Volume>>(
        "continuous", fcl::CCDC_CONSERVATIVE_ADVANCEMENT, std::size_t{10})};
}

} // namespace

std::vector<ContenderEntry> fcl_motions() {
    std::vector<ContenderEntry> all;
    append_continuous<fcl::OBBRSSd>(all);
    append_stepped<fcl::OBBRSSd>(all);
    append_continuous<fcl::RSSd>(all);
    append_stepped<fcl::RSSd>(all);
    append_stepped<fcl::OBBRSSf>(all);
    append_stepped<fcl::RSSf>(all);
    ContenderEntry& sampled = all.emplace_back(entry_of_motions<fcl::OBBRSSd>(
        ".sampled",
        "continuousCollide by 100 samples, its default way with ten times its number of samples: "
        "what is between two of them is passed through, and a contact is found too late"));
    sampled.answers = {
        answering<FirstMeetings<fcl::OBBRSSd>>("continuous", fcl::CCDC_NAIVE, std::size_t{100})};
    return all;
}

} // namespace boxwood::bench
