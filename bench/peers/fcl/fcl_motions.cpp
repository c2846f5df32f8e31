#include "bench/peers/answering.h"
#include "bench/peers/fcl/mesh_models.h"
#include "bench/peers/mesh_peers.h"

#include <fcl/math/motion/interp_motion.h>
#include <fcl/math/motion/screw_motion.h>
#include <fcl/math/motion/translation_motion.h>
#include <fcl/narrowphase/continuous_collision.h>
#include <fmt/format.h>

#include <memory>
#include <string>

namespace boxwood::bench {
namespace {

/// Not InterpMotion(from, to), which leaves the point unset that goes straight.
std::unique_ptr<fcl::MotionBased> motion_between(const fcl::Transform3d& from,
                                                 const fcl::Transform3d& to, bool is_screw) {
    if (is_screw)
        return std::make_unique<fcl::ScrewMotion<double>>(from, to);
    return std::make_unique<fcl::InterpMotion<double>>(from.linear(), from.translation(), to.linear(),
                                                to.translation(), fcl::Vector3d::Zero());
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
            fcl::continuousCollide<double>(this->model_.get(), &still, this->model_.get(),
                                           motion.get(), request_, result);
            const double t = result.is_collide ? result.time_of_contact : 1;
            meetings.push_back({t, t, result.is_collide ? Meets::yes : Meets::no});
        }
    }

  private:
    bool is_screw_;
    fcl::ContinuousCollisionRequestd request_;
};

template <class Volume>
ContenderEntry meetings_of(const std::string& name, const std::string& volume,
                           fcl::CCDSolverType solver, std::size_t samples, const std::string& how) {
    ContenderEntry e;
    e.name = "fcl." + name;
    e.library = "fcl";
    e.summary = fmt::format("FCL's BVHModel of {}, continuousCollide by {}", volume, how);
    e.notes = fmt::format("build = one model, which stands for the mesh and for its copy; query = "
                          "motion after motion, made from its two poses in the query; "
                          "CCDM_LINEAR's point that goes straight is the copy's origin; {}; "
                          "doubles; one thread",
                          how);
    e.precision = "f64";
    e.runs_on = RunsOn::one_thread;
    e.answers = {answering<FirstMeetings<Volume>>("continuous", solver, samples)};
    return e;
}

} // namespace

std::vector<ContenderEntry> fcl_motions() {
    const std::string advancement =
        "conservative advancement, which ends where a step is 1e-5 of the motion: that is fixed, "
        "toc_err and num_max_iterations are not read";
    const std::string samples =
        "100 samples, its default way with ten times its number of samples: what is between two "
        "of them is passed through, and a contact is found too late";
    return {meetings_of<fcl::OBBRSSd>("obbrss.continuous", "OBBRSS",
                                      fcl::CCDC_CONSERVATIVE_ADVANCEMENT, 10, advancement),
            meetings_of<fcl::RSSd>("rss.continuous", "RSS", fcl::CCDC_CONSERVATIVE_ADVANCEMENT, 10,
                                   advancement),
            meetings_of<fcl::OBBRSSd>("obbrss.sampled", "OBBRSS", fcl::CCDC_NAIVE, 100, samples)};
}

} // namespace boxwood::bench
