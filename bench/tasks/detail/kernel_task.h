#pragma once

#include "bench/tasks/detail/one_by_one.h"
#include "bench/tasks/task.h"
#include "bench/truth/judging/case_truths.h"
#include "kernels/continuous/continuous_kernel.h"
#include "kernels/triangle_distance/distance_kernel.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace boxwood::bench {

/// A kernel of ours and what makes it a contender on cases.
struct CaseKernel {
    KernelInfo info;
    std::string precision;       ///< f32 | f64: what the kernel reads
    std::string_view how_called; ///< for the notes
    std::function<std::unique_ptr<Contender>(const Cases&)> make;
    Answering::Make make_on_device{}; ///< null if it has no form for a device
};

/// A task that is a family of kernels: one answer to each case of a family of hard cases, on one
/// thread or on a device. Ours are the kernels of the registries, by name; the rational ones come
/// last.
class KernelTask : public Task {
  public:
    using MakeTruth = std::unique_ptr<CaseTruth> (*)(const CaseScene&);

    KernelTask(std::string_view name, std::string_view summary, std::vector<CaseKernel> kernels,
               MakeTruth make_truth);

    std::string_view name() const override { return name_; }
    std::string_view summary() const override { return summary_; }
    std::vector<std::string_view> keys() const override;
    SceneKind scenes() const override { return SceneKind::cases; }
    void expand(const BlockReader& block, AddCell add) const override;
    std::span<const KernelInfo> kernels() const override { return infos_; }
    /// Throws std::invalid_argument, with a suggestion, for a name that kernels() does not have.
    ContenderEntry kernel_contender(std::string_view kernel) const override;
    std::vector<ContenderEntry> contenders_on_cases() const override;
    std::optional<std::string> missing(const Scene& scene) const override;
    std::uint64_t n_queries(const Scene& scene) const override { return n_cases(scene.cases); }
    Phases phases() const override { return Phases::query; }
    /// Throws std::invalid_argument for a scene whose cases do not fit.
    std::unique_ptr<Truth> make_truth(const Scene& scene, unsigned threads) const override;

  private:
    std::string_view name_, summary_;
    std::vector<CaseKernel> kernels_;
    std::vector<KernelInfo> infos_;
    MakeTruth make_truth_;
};

// Answers as words, to be hashed: of numbers the bits, padding left out.
void append_words(std::vector<std::uint64_t>& words, const Decision& verdict);
void append_words(std::vector<std::uint64_t>& words, const Distance& distance);
void append_words(std::vector<std::uint64_t>& words, const Impact& impact);
void append_words(std::vector<std::uint64_t>& words, const Aabb<double>& box);
void append_words(std::vector<std::uint64_t>& words, const RayHit& hit);
std::uint64_t hash_of_words(const std::vector<std::uint64_t>& words);

/// A family whose kernels answer a T to a case of type Case.
template <class T, class Case> class KernelTaskOf : public KernelTask {
  public:
    using KernelTask::KernelTask;
    bool fits(const Cases& cases) const override { return std::holds_alternative<Case>(cases); }
    std::unique_ptr<Answers> make_answers() const override {
        return std::make_unique<AnswerList<T>>();
    }
    std::uint64_t hash(const Answers& answers) const override {
        std::vector<std::uint64_t> words;
        for (const T& answer : list_of<T>(answers))
            append_words(words, answer);
        return hash_of_words(words);
    }
};

/// f(std::type_identity<K>{}) for each K of a tuple.
template <class Kernels, class F> void for_each_kernel(F&& f) {
    [&]<class... K>(std::type_identity<std::tuple<K...>>) {
        (f(std::type_identity<K>{}), ...);
    }(std::type_identity<Kernels>{});
}

template <class... Tuples> using Concatenated = decltype(std::tuple_cat(std::declval<Tuples>()...));

/// What `make` says of each kernel type of a tuple.
template <class Kernels, class Make> std::vector<CaseKernel> all_kernels(Make&& make) {
    std::vector<CaseKernel> all;
    for_each_kernel<Kernels>([&]<class K>(std::type_identity<K> k) { all.push_back(make(k)); });
    return all;
}

/// The number type that a kernel reads: K::Real, or `Default` if its concept has no such member.
template <class K, class Default> struct RealOf { using type = Default; };
template <class K, class Default>
requires requires { typename K::Real; }
struct RealOf<K, Default> {
    using type = typename K::Real;
};
template <class Real> std::string precision_of() {
    return std::is_same_v<Real, float> ? "f32" : "f64";
}

inline constexpr std::string_view called_one_by_one = "one case per call";

template <class To, class From> Triangle<To> converted(const Triangle<From>& t) {
    return {static_cast<Vec3<To>>(t.a), static_cast<Vec3<To>>(t.b), static_cast<Vec3<To>>(t.c)};
}

/// A kernel that is called for one case after the other, each made an `Input`.
template <class K, class Input, class Case, class Function>
CaseKernel scalar_kernel(Function function) {
    return {K::info, precision_of<typename K::Real>(), called_one_by_one,
            [function](const Cases& cases) {
                std::vector<Input> inputs;
                for (const Case& c : std::get<std::vector<Case>>(cases))
                    inputs.emplace_back(c);
                return one_by_one(std::move(inputs), function);
            }};
}

/// Kernels of the distance of the two sides of an `Input`.
template <class Kernels, template <class> class Input> std::vector<CaseKernel> distance_kernels() {
    return all_kernels<Kernels>([]<class K>(std::type_identity<K>) {
        return scalar_kernel<K, Input<typename K::Real>, TrianglePairCase>(
            [](const auto& in) { return K::distance(in.a, in.b); });
    });
}

} // namespace boxwood::bench
