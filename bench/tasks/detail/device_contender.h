#pragma once

#include "bench/tasks/contender.h"
#include "bench/tasks/detail/bench_place.h"
#include "bench/tasks/task.h"
#include "trees/device.h"

#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace boxwood::bench {

/// What our contenders on a device share. `cuda`: build and query begin and end in host memory.
/// `cuda_resident`: boxes and answers stay on the device, and answers may come in any order.
/// `cuda_graph`: so, in a stream of its own.
class DeviceContender : public Contender {
  public:
    explicit DeviceContender(const Job& job) : is_resident_(job.executor != device_executor) {
        if (job.executor == graph_executor)
            stream_.emplace(bench_place().index);
    }

    void build() override;
    void query(Answers& answers) override;
    void fetch(Answers& answers) override;
    std::vector<DeviceTime> device_times(Answers& answers) override;
    std::vector<NamedCount> more_counts() const override;

  protected:
    // In this order; only what is on the device when they come back is promised. What crosses gives
    // its bytes.
    virtual std::uint64_t upload() = 0; ///< what is built from
    virtual void build_there() = 0;
    virtual std::uint64_t upload_queries() { return 0; }
    virtual void query_there() = 0;
    virtual std::uint64_t download(Answers& answers) = 0;
    /// What the host has into the form that answers are judged in, untimed.
    virtual void convert(Answers&) {}

    bool is_resident() const { return is_resident_; }
    DevicePlace place() const { return stream_ ? stream_->place() : bench_place(); }

  private:
    std::optional<DeviceStream> stream_;
    bool is_resident_;
    bool is_uploaded_ = false;
    std::uint64_t build_launches_ = 0, query_launches_ = 0;
    std::uint64_t upload_bytes_ = 0, query_upload_bytes_ = 0, download_bytes_ = 0;
};

/// By whom the device makes a tree as this builder and layout do; nothing if it has no such form.
/// The tree of ploc is made there by H-PLOC.
std::optional<DeviceBuilder> device_builder(const Choice& choice, std::string_view layout_of_trees);

/// A tree of the scene's boxes.
class DeviceBoxes : public DeviceContender {
  public:
    DeviceBoxes(const Job& job, DeviceBuilder builder)
        : DeviceContender(job), scene_(*job.scene), options_{builder, place()} {}

    std::vector<NamedCount> more_counts() const override;

  protected:
    std::uint64_t upload() override;
    void build_there() override;

    const Scene& scene_;
    DeviceBvhOptions options_;
    DeviceArray<Box> boxes_;
    std::optional<DeviceBvh> bvh_;
};

/// Answers that come to the host as they are, and are pairs (query, item) then.
class ItemsOfQueries : public DeviceBoxes {
  public:
    using DeviceBoxes::DeviceBoxes;

  protected:
    std::uint64_t download(Answers& answers) override;
    void convert(Answers& answers) override;

    DeviceAnswersOf<std::uint32_t> found_;

  private:
    AnswersOf<std::uint32_t> on_host_;
};

/// Makes a contender of class C on a device, if the choice has a form there.
template <class C>
std::function<std::unique_ptr<Contender>(const Job&)>
on_device(const Choice& choice, std::string_view layout_of_trees = "binary") {
    const std::optional<DeviceBuilder> builder = device_builder(choice, layout_of_trees);
    if (!builder)
        return nullptr;
    return [builder = *builder](const Job& job) { return std::make_unique<C>(job, builder); };
}

} // namespace boxwood::bench
