#include "scenes/moving/moving_scene.h"

#include "kernels/arithmetic/rounding.h"
#include "scenes/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

namespace boxwood {
namespace {

Vec3<double> size_of(const Aabb<float>& box) {
    return static_cast<Vec3<double>>(box.max) - static_cast<Vec3<double>>(box.min);
}

/// The mesh, each axis scaled so that its bounds become `box`.
TriangleMesh filling(const TriangleMesh& mesh, const Aabb<float>& bounds, const Aabb<float>& box) {
    const Vec3<double> from = size_of(bounds), to = size_of(box);
    TriangleMesh scaled = mesh;
    for (Vec3<float>& vertex : scaled.vertices)
        for (int axis = 0; axis < 3; ++axis) {
            const double share =
                from[axis] > 0
                    ? (static_cast<double>(vertex[axis]) - static_cast<double>(bounds.min[axis])) /
                          from[axis]
                    : .5;
            vertex[axis] = std::clamp(
                static_cast<float>(static_cast<double>(box.min[axis]) + share * to[axis]),
                box.min[axis], box.max[axis]);
        }
    return scaled;
}

/// To 12 bits: boxes of one size, wherever they stood when they were rounded to floats.
double rounded(double side) {
    int exponent = 0;
    const double mantissa = std::frexp(side, &exponent);
    return std::ldexp(std::round(std::ldexp(mantissa, 12)), exponent - 12);
}

/// Gives the bodies from `first` on meshes that fill their boxes; boxes of one size share one.
void fill_boxes(Bodies& bodies, std::uint32_t first, const TriangleMesh& mesh) {
    Aabb<float> bounds;
    for (const Vec3<float>& vertex : mesh.vertices)
        bounds.extend(vertex);
    std::map<std::array<double, 3>, std::uint32_t> made;
    for (std::uint32_t i = first; i < bodies.size(); ++i) {
        const Vec3<double> size = size_of(bodies.rest[i]);
        const Vec3<double> half{rounded(size.x) / 2, rounded(size.y) / 2, rounded(size.z) / 2};
        bodies.rest[i] = {static_cast<Vec3<float>>(-half), static_cast<Vec3<float>>(half)};
        const auto [at, is_new] = made.try_emplace(
            {half.x, half.y, half.z}, static_cast<std::uint32_t>(bodies.meshes.size()));
        if (is_new)
            bodies.meshes.push_back(filling(mesh, bounds, bodies.rest[i]));
        bodies.mesh[i] = at->second;
    }
}

double mean_side(const Bodies& bodies) {
    double sum = 0;
    for (const Aabb<float>& box : bodies.rest) {
        const Vec3<double> size = size_of(box);
        sum += size.x + size.y + size.z;
    }
    return sum / (3 * static_cast<double>(bodies.size()));
}

/// The bodies of a group that an effect is laid on, at random: the same for any n.
std::vector<std::uint32_t> drawn(const Random& random, double share, std::uint32_t first,
                                 std::uint32_t last) {
    std::vector<std::uint32_t> chosen;
    for (std::uint32_t i = first; i < last; ++i)
        if (share == 1 || random.item(i).uniform() < share)
            chosen.push_back(i);
    return chosen;
}

} // namespace

MovingScene::MovingScene(SceneFile file, std::optional<std::size_t> n, bool can_rewind)
    : file_(std::move(file)) {
    if (n)
        file_.n = *n;
    std::vector<std::uint32_t> firsts;
    for (std::size_t g = 0; g < file_.groups.size(); ++g) {
        firsts.push_back(static_cast<std::uint32_t>(bodies_.size()));
        add_group(file_.groups[g], g);
    }
    if (bodies_.size() == 0)
        throw std::invalid_argument(
            fmt::format("scene {}: the shares of n = {} leave no body", file_.name, file_.n));
    bodies_.side = mean_side(bodies_);
    changed_ = Changed(bodies_.size());
    firsts.push_back(static_cast<std::uint32_t>(bodies_.size()));
    for (std::size_t g = 0; g < file_.groups.size(); ++g)
        lay_effects(file_.groups[g], g, firsts[g], firsts[g + 1]);
    std::ranges::sort(with_velocity_);
    with_velocity_.erase(std::unique(with_velocity_.begin(), with_velocity_.end()),
                         with_velocity_.end());
    if (can_rewind)
        unmoved_ = std::make_unique<const Bodies>(bodies_);
    start_effects();
}

void MovingScene::add_group(const BodyGroup& group, std::size_t index) {
    const auto first = static_cast<std::uint32_t>(bodies_.size());
    const double share = std::round(group.share * static_cast<double>(file_.n));
    const std::size_t n = group.n ? group.n : static_cast<std::size_t>(share);
    if (n == 0)
        return;
    // Groups of one generator must not stand on each other.
    const std::uint64_t seed = file_.seed + 0x9e3779b97f4a7c15u * index;
    Scene made = make_scene(
        {.generator = group.generator, .n = n, .seed = seed, .overlaps = group.overlaps});
    if (bodies_.size() + made.boxes.size() >= no_mesh)
        throw std::invalid_argument(
            fmt::format("scene {}: too many bodies; they are numbered by 32 bits", file_.name));
    const auto scale = static_cast<float>(group.scale);
    if (!made.mesh.triangles.empty()) {
        for (Vec3<float>& vertex : made.mesh.vertices)
            vertex = scale * vertex;
        bodies_.add(made.mesh);
    } else {
        for (const Aabb<float>& box : made.boxes)
            bodies_.add({scale * box.min, scale * box.max});
    }
    for (std::uint32_t i = first; i < bodies_.size(); ++i) {
        Vec3<double>& place = bodies_.pose[i].translation;
        place = place + group.at;
        bodies_.bounds.extend(place);
    }
    if (!group.shape.empty() && made.mesh.triangles.empty())
        fill_boxes(bodies_, first,
                   make_scene({.generator = group.shape, .n = group.triangles, .seed = seed}).mesh);
    const auto last = static_cast<std::uint32_t>(bodies_.size());
    if (group.neighbours_ignored || group.group_ignored)
        ignored_.push_back({first, last, group.group_ignored});
    if (group.margin > 0)
        margins_.push_back({first, last, group.margin});
}

/// Gives each of these bodies a mesh that no other has.
void MovingScene::own_meshes(std::span<const std::uint32_t> bodies) {
    std::vector<std::uint32_t> users(bodies_.meshes.size());
    for (const std::uint32_t mesh : bodies_.mesh)
        if (mesh != no_mesh)
            ++users[mesh];
    for (const std::uint32_t i : bodies) {
        std::uint32_t& mesh = bodies_.mesh[i];
        if (mesh == no_mesh || users[mesh] == 1)
            continue;
        --users[mesh];
        TriangleMesh own = bodies_.meshes[mesh];
        mesh = static_cast<std::uint32_t>(bodies_.meshes.size());
        bodies_.meshes.push_back(std::move(own));
        users.push_back(1);
    }
}

void MovingScene::lay_effects(const BodyGroup& group, std::size_t index, std::uint32_t first,
                              std::uint32_t last) {
    for (std::size_t k = 0; k < group.effects.size(); ++k) {
        const auto& [name, settings, share] = group.effects[k];
        const EffectEntry& entry = effect_of(name);
        const Random choice(file_.seed, fmt::format("{}.{}.{}.chosen", name, index, k));
        std::vector<std::uint32_t> chosen = drawn(choice, share, first, last);
        if (entry.changes == Changes{.shape = true})
            std::erase_if(chosen, [&](std::uint32_t i) { return bodies_.mesh[i] == no_mesh; });
        if (chosen.empty())
            continue;
        if (entry.changes.shape)
            own_meshes(chosen);
        changes_ = changes_ | entry.changes;
        if (entry.changes.velocity)
            with_velocity_.insert(with_velocity_.end(), chosen.begin(), chosen.end());
        const Random random(file_.seed, fmt::format("{}.{}.{}", name, index, k));
        effects_.push_back({&entry, std::move(chosen), entry.make(settings), random});
    }
}

void MovingScene::start_effects() {
    for (const Laid& laid : effects_) {
        Moment moment = moment_of(laid);
        laid.effect->start(moment);
    }
}

void MovingScene::rewind() {
    if (!unmoved_)
        throw std::logic_error("a moving scene rewinds only if it was made to");
    bodies_ = *unmoved_;
    frame_ = 0;
    start_effects();
}

Moment MovingScene::moment_of(const Laid& laid) {
    return {bodies_, laid.chosen, changed_, laid.random, frame_, 1 / file_.frames_per_second};
}

void MovingScene::begin_frame() {
    ++frame_;
    changed_.clear();
}

void MovingScene::advance_effect(std::size_t i) {
    Moment moment = moment_of(effects_[i]);
    effects_[i].effect->advance(moment);
}

std::optional<BodyStep> MovingScene::step(std::size_t i) {
    const Laid& laid = effects_[i];
    return laid.effect->step(moment_of(laid));
}

MoveStep MovingScene::move_step() const {
    return {bodies_.bounds, bodies_.bounce, file_.frames_per_second};
}

void MovingScene::move(std::span<const std::uint32_t> bodies) {
    const MoveStep along = move_step();
    for (const std::uint32_t i : bodies)
        if (along(bodies_.pose[i].translation, bodies_.velocity[i]))
            changed_.add(i);
}

std::span<const std::uint32_t> MovingScene::end_frame() {
    changed_.sort();
    return changed_.bodies();
}

std::span<const std::uint32_t> MovingScene::advance() {
    begin_frame();
    for (std::size_t i = 0; i < effects_.size(); ++i)
        advance_effect(i);
    move(with_velocity_);
    return end_frame();
}

Aabb<float> pair_box(const MovingScene& scene, std::uint32_t i) {
    const Aabb<float> box = fitted_box(scene.bodies(), i);
    for (const Margin& margin : scene.margins())
        if (margin.first <= i && i < margin.last && !box.is_empty()) {
            const Vec3<double> by{margin.margin, margin.margin, margin.margin};
            return round_outward(
                {static_cast<Vec3<double>>(box.min) - by, static_cast<Vec3<double>>(box.max) + by});
        }
    return box;
}

} // namespace boxwood
