#include "bench/tasks/detail/pairs_on_device.h"

#include "bench/tasks/detail/device_contender.h"
#include "bench/tasks/detail/kernel_task.h"

#include <tuple>

namespace boxwood::bench {
namespace {

Distance distance_of(const DistanceBounds& bounds, std::uint8_t tier) {
    const double middle = bounds.lo + (bounds.hi - bounds.lo) / 2;
    Distance distance;
    distance.distance = bounds.hi == bounds.lo ? bounds.lo : middle;
    distance.lo = bounds.lo;
    distance.hi = bounds.hi;
    distance.tier = tier;
    return distance;
}

/// Triangle i of one list with triangle i of the other.
class PairsOnDevice : public DeviceContender {
  public:
    PairsOnDevice(const Job& job, DeviceAccuracy accuracy)
        : DeviceContender(job), accuracy_(accuracy) {
        for (const auto& c : std::get<std::vector<TrianglePairCase>>(job.scene->cases)) {
            pairs_.push_back({static_cast<std::uint32_t>(pairs_.size()),
                              static_cast<std::uint32_t>(pairs_.size())});
            for (const auto& [side, of] : {std::pair{&a_, &c.a}, {&b_, &c.b}}) {
                const auto t = converted<float>(*of);
                side->insert(side->end(), {t.a, t.b, t.c});
            }
        }
    }

  protected:
    std::uint64_t upload() override { return 0; }
    void build_there() override {}
    std::uint64_t upload_queries() override {
        on_a_ = DeviceArray<Vec3<float>>(a_, place());
        on_b_ = DeviceArray<Vec3<float>>(b_, place());
        on_pairs_ = DeviceArray<Pair>(pairs_, place());
        return on_a_.size_bytes() + on_b_.size_bytes() + on_pairs_.size_bytes();
    }
    DeviceTriangles a() const { return {on_a_.span()}; }
    DeviceTriangles b() const { return {on_b_.span()}; }
    DeviceSpan<const Pair> pairs() const { return on_pairs_.span(); }

    std::vector<NamedCount> counts(const DeviceArray<UncertainPairs>& of,
                                   std::size_t answer_bytes) const {
        std::vector<NamedCount> counts = DeviceContender::more_counts();
        counts.push_back({"query_bytes", pairs_.size() * (2 * sizeof(Triangle<float>) +
                                                          sizeof(Pair) + answer_bytes)});
        if (of.size() > 0 && accuracy_ >= DeviceAccuracy::certified)
            counts.push_back({"uncertain", of.to_host()[0].n});
        return counts;
    }
    DeviceAccuracy accuracy_;

  private:
    std::vector<Vec3<float>> a_, b_;
    std::vector<Pair> pairs_;
    DeviceArray<Vec3<float>> on_a_, on_b_;
    DeviceArray<Pair> on_pairs_;
};

class TouchingOnDevice final : public PairsOnDevice {
  public:
    using PairsOnDevice::PairsOnDevice;
    std::vector<NamedCount> more_counts() const override {
        return counts(found_.uncertain, sizeof(Answer));
    }

  private:
    void query_there() override { found_ = triangles_touch(a(), b(), pairs(), accuracy_, place()); }
    std::uint64_t download(Answers&) override {
        found_.of.read(answers_);
        return found_.of.size_bytes();
    }
    void convert(Answers& answers) override {
        std::vector<Decision>& out = list_of<Decision>(answers);
        out.clear();
        for (const Answer answer : answers_)
            out.push_back({answer, 0});
    }
    DevicePairAnswers<Answer> found_;
    std::vector<Answer> answers_;
};

class DistancesOnDevice final : public PairsOnDevice {
  public:
    using PairsOnDevice::PairsOnDevice;
    std::vector<NamedCount> more_counts() const override {
        return counts(found_.uncertain, sizeof(DistanceBounds));
    }

  private:
    void query_there() override {
        found_ = triangle_distances(a(), b(), pairs(), accuracy_, place());
    }
    std::uint64_t download(Answers&) override {
        found_.of.read(bounds_);
        return found_.of.size_bytes();
    }
    void convert(Answers& answers) override {
        std::vector<Distance>& out = list_of<Distance>(answers);
        out.clear();
        for (const DistanceBounds& bounds : bounds_)
            out.push_back(distance_of(bounds, 0));
    }
    DevicePairAnswers<DistanceBounds> found_;
    std::vector<DistanceBounds> bounds_;
};

template <class C> Answering::Make maker_of(std::optional<DeviceAccuracy> accuracy) {
    if (!accuracy)
        return nullptr;
    return [accuracy = *accuracy](const Job& job) { return std::make_unique<C>(job, accuracy); };
}

} // namespace

std::optional<DeviceAccuracy> device_accuracy(std::string_view kernel) {
    if (kernel == "guigue_devillers_f32_batch")
        return DeviceAccuracy::plain;
    if (kernel == CertifiedF32::name)
        return DeviceAccuracy::certified;
    if (kernel == "guigue_devillers_exact_f32_batch")
        return DeviceAccuracy::exact;
    return std::nullopt;
}

Answering::Make touching_on_device(std::string_view kernel) {
    return maker_of<TouchingOnDevice>(device_accuracy(kernel));
}
Answering::Make distances_on_device(std::string_view kernel) {
    return maker_of<DistancesOnDevice>(
        kernel == "features_f32"               ? std::optional(DeviceAccuracy::plain)
        : kernel == CertifiedDistanceF32::name ? std::optional(DeviceAccuracy::exact)
                                               : std::nullopt);
}

Distance CertifiedDistanceF32::distance(const Triangle<float>& a, const Triangle<float>& b) {
    bool sure = false;
    DistanceBounds bounds = float_pair::certified_distance(a, b, sure);
    if (sure)
        return distance_of(bounds, 0);
    if (float_pair::exact_distance<1>(a, b, bounds))
        return distance_of(bounds, 1);
    float_pair::exact_distance<5>(a, b, bounds);
    return distance_of(bounds, 2);
}

} // namespace boxwood::bench
