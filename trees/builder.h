#pragma once

#include "kernels/primitives/triangle.h"
#include "kernels/settings.h"
#include "trees/executor.h"
#include "trees/tree.h"

#include <concepts>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

namespace boxwood {

/// A builder makes the canonical tree of any number of boxes: the same tree on every executor.
/// It throws InvalidBox for a box with a NaN, an infinity or min > max. Its settings are documented
/// data members with defaults, listed by `settings()` so that a sweep file can reach them.
template <class B>
concept Builder = std::default_initializable<B> && std::copy_constructible<B> && ListsSettings<B> &&
    requires(const B builder, Boxes boxes, const Executor& executor) {
    { builder.build(boxes, executor) } -> std::same_as<Tree>;
    { B::name } -> std::convertible_to<std::string_view>;
    { B::summary } -> std::convertible_to<std::string_view>;
};

/// A builder that finds a good order of the items without a tree: slot -> item.
template <class B>
concept OrderBuilder = Builder<B> &&
    requires(const B builder, Boxes boxes, const Executor& executor) {
    { builder.order(boxes, executor) } -> std::same_as<Buffer<std::uint32_t>>;
};

/// A builder that makes more of triangles than of their boxes.
template <class B>
concept MeshBuilder = Builder<B> &&
    requires(const B builder, const TriangleMesh& mesh, const Executor& executor) {
    { builder.build_of_mesh(mesh, executor) } -> std::same_as<Tree>;
};

/// A builder with its settings, and with the optimizer after it if one is named: a Builder of any
/// type, BinnedSahBuilder{.bins = 16} or your own, is taken for one.
struct BuildFunction {
    BuildFunction() = default;
    template <class B>
    requires(!std::same_as<B, BuildFunction>) && Builder<B> BuildFunction(
                                                     B builder); // NOLINT: implicit by design

    std::function<Tree(Boxes, const Executor&)> build;
    /// The items as the leaves of the tree would have them, without the tree; empty if the builder
    /// needs the tree for it. Throws as `build` does.
    std::function<Buffer<std::uint32_t>(Boxes, const Executor&)> order;
    /// A tree for rays of triangles rather than boxes, split (see Tree) or not; empty if the
    /// builder sees boxes alone. Throws InvalidBox for a triangle with a NaN or an infinity.
    std::function<Tree(const TriangleMesh&, const Executor&)> build_of_mesh;

    Tree operator()(Boxes boxes, const Executor& executor) const { return build(boxes, executor); }
};

/// A registry row. `make` throws std::invalid_argument for an unknown or out-of-range setting.
struct BuilderEntry {
    std::string_view name, summary;
    std::vector<SettingInfo> settings;
    std::function<BuildFunction(const Settings&)> make;
    bool is_reference = false; ///< the one that the others are held against
};

std::span<const BuilderEntry> builders();

/// The builder by its registered name. Throws std::invalid_argument for an unknown one, with a
/// suggestion.
const BuilderEntry& find_builder(std::string_view name);

/// An optimizer improves a finished tree: same items, a valid canonical tree, the same on every
/// executor. Settings as a builder's.
template <class O>
concept Optimizer = std::default_initializable<O> && std::copy_constructible<O> &&
    ListsSettings<O> && requires(const O optimizer, Tree& tree, const Executor& executor) {
    { optimizer.improve(tree, executor) } -> std::same_as<void>;
    { O::name } -> std::convertible_to<std::string_view>;
    { O::summary } -> std::convertible_to<std::string_view>;
};
struct OptimizerEntry {
    std::string_view name, summary;
    std::vector<SettingInfo> settings;
    std::function<std::function<void(Tree&, const Executor&)>(const Settings&)> make;
};
std::span<const OptimizerEntry> optimizers();

/// "ploc", or with an optimizer after it "ploc+reinsertion"; each setting goes to the one that has
/// it. Throws std::invalid_argument for an unknown name or setting, with a suggestion.
BuildFunction make_builder(std::string_view name, const Settings& settings = {});

template <class B>
requires(!std::same_as<B, BuildFunction>) && Builder<B> BuildFunction::BuildFunction(B builder)
    : build([builder](Boxes boxes, const Executor& executor) {
          return builder.build(boxes, executor);
      }) {
    if constexpr (OrderBuilder<B>)
        order = [builder](Boxes boxes, const Executor& executor) {
            return builder.order(boxes, executor);
        };
    if constexpr (MeshBuilder<B>)
        build_of_mesh = [builder](const TriangleMesh& mesh, const Executor& executor) {
            return builder.build_of_mesh(mesh, executor);
        };
}

/// The registry row of a Builder type.
template <Builder B> BuilderEntry builder_entry() {
    return {B::name, B::summary, setting_infos<B>(),
            [](const Settings& values) -> BuildFunction { return with_settings<B>(values); }};
}

/// The registry row of an Optimizer type.
template <Optimizer O> OptimizerEntry optimizer_entry() {
    return {O::name, O::summary, setting_infos<O>(), [](const Settings& values) {
                return
                    [optimizer = with_settings<O>(values)](Tree& tree, const Executor& executor) {
                        optimizer.improve(tree, executor);
                    };
            }};
}

} // namespace boxwood
