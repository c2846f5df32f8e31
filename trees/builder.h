#pragma once

#include "kernels/settings.h"
#include "kernels/primitives/triangle.h"
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
/// One that finds a good order of the items without a tree may hand it out by `order`, and one that
/// makes more of triangles than their boxes may do so by `build_of_mesh`.
template <class B>
concept Builder = std::default_initializable<B> &&
    requires(const B builder, Boxes boxes, const Executor& executor) {
    { builder.build(boxes, executor) } -> std::same_as<Tree>;
    { B::name } -> std::convertible_to<std::string_view>;
    { B::summary } -> std::convertible_to<std::string_view>;
};

/// A builder with its settings, and with the stage after it if one is named.
struct BuildFunction {
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
};

std::span<const BuilderEntry> builders();

/// The builder by its registry word, or nullptr.
const BuilderEntry* find_builder(std::string_view name);

/// A stage improves a finished tree: same items, a valid canonical tree, the same on every
/// executor. Settings as a builder's.
template <class S>
concept Stage = std::default_initializable<S> &&
    requires(const S stage, Tree& tree, const Executor& executor) {
    stage.improve(tree, executor);
    { S::name } -> std::convertible_to<std::string_view>;
    { S::summary } -> std::convertible_to<std::string_view>;
};
struct OptimizerEntry {
    std::string_view name, summary;
    std::vector<SettingInfo> settings;
    std::function<std::function<void(Tree&, const Executor&)>(const Settings&)> make;
};
std::span<const OptimizerEntry> stages();

/// "ploc", or with a stage after it "ploc+reinsertion"; each setting goes to the one that has it.
/// Throws std::invalid_argument for an unknown word or setting, with a suggestion.
BuildFunction make_builder(std::string_view words, const Settings& settings = {});

/// The registry row of a Builder type.
template <Builder B> BuilderEntry builder_entry() {
    return {B::name, B::summary, setting_infos<B>(), [](const Settings& values) {
                const B builder = with_settings<B>(values);
                BuildFunction made;
                made.build = [builder](Boxes boxes, const Executor& executor) {
                    return builder.build(boxes, executor);
                };
                if constexpr (requires(Boxes b, const Executor& e) { builder.order(b, e); })
                    made.order = [builder](Boxes boxes, const Executor& executor) {
                        return builder.order(boxes, executor);
                    };
                if constexpr (requires(const TriangleMesh& m, const Executor& e) {
                                  builder.build_of_mesh(m, e);
                              })
                    made.build_of_mesh = [builder](const TriangleMesh& mesh,
                                                   const Executor& executor) {
                        return builder.build_of_mesh(mesh, executor);
                    };
                return made;
            }};
}

/// The registry row of a Stage type.
template <Stage S> OptimizerEntry optimizer_entry() {
    return {S::name, S::summary, setting_infos<S>(), [](const Settings& values) {
                return [stage = with_settings<S>(values)](Tree& tree, const Executor& executor) {
                    stage.improve(tree, executor);
                };
            }};
}

} // namespace boxwood
