#include "scenes/moving/frames.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <xxhash.h>

#include <algorithm>
#include <new>

namespace boxwood {
namespace {

/// To the next frame of the scene; `frame` holds the last one.
void advance(MovingScene& scene, Frame& frame) {
    frame.moved.clear();
    for (const std::uint32_t body : scene.advance()) {
        const Aabb<float> box = pair_box(scene, body);
        if (box == frame.boxes[body])
            continue;
        frame.boxes[body] = box;
        frame.moved.push_back(body);
    }
}

template <class T> std::size_t bytes_of(const std::vector<T>& elements) {
    return elements.capacity() * sizeof(T);
}

std::size_t bytes_of(const Frame& frame) { return bytes_of(frame.boxes) + bytes_of(frame.moved); }

std::size_t bytes_of(const Bodies& bodies) {
    return bytes_of(bodies.rest) + bytes_of(bodies.mesh) + bytes_of(bodies.pose) +
           bytes_of(bodies.velocity) + bytes_of(bodies.present);
}

} // namespace

std::vector<Aabb<float>> boxes_at_start(const SceneFile& file) {
    return file.recording ? file.recording->front() : boxes_of(MovingScene(file));
}

std::vector<Aabb<float>> boxes_of(const MovingScene& scene) {
    std::vector<Aabb<float>> boxes(scene.bodies().size());
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
        boxes[i] = pair_box(scene, i);
    return boxes;
}

Frames::Frames(std::shared_ptr<const SceneFile> file, std::size_t max_bytes)
    : file_(std::move(file)) {
    start_ = boxes_at_start(*file_);
    if (file_->recording) {
        bake(*file_->recording);
        return;
    }
    scene_ = std::make_unique<MovingScene>(*file_);
    is_baked_ = size() <= max_bytes / (start_.size() * sizeof(start_[0]));
    if (!is_baked_) {
        now_.boxes = start_;
        return;
    }
    Frame frame{start_, {}};
    baked_.reserve(size());
    while (baked_.size() < size()) {
        advance(*scene_, frame);
        baked_.push_back(frame);
    }
    scene_.reset();
}

void Frames::bake(const Recording& recording) {
    is_baked_ = true;
    for (std::size_t i = 1; i <= size(); ++i) {
        baked_.push_back({recording[i], {}});
        for (std::uint32_t body = 0; body < start_.size(); ++body)
            if (!(recording[i][body] == recording[i - 1][body]))
                baked_.back().moved.push_back(body);
    }
}

const Frame* Frames::next() {
    if (played_ == size())
        return nullptr;
    ++played_;
    if (is_baked_)
        return &baked_[played_ - 1];
    advance(*scene_, now_);
    return &now_;
}

void Frames::rewind() {
    if (played_ > 0 && !is_baked_) {
        scene_.reset(); // before its successor takes as much memory
        scene_ = std::make_unique<MovingScene>(*file_);
        now_.boxes = start_;
    }
    played_ = 0;
}

std::size_t Frames::bytes() const {
    std::size_t bytes = bytes_of(start_) + bytes_of(now_) + bytes_of(baked_);
    for (const Frame& frame : baked_)
        bytes += bytes_of(frame);
    return bytes + (scene_ ? bytes_of(scene_->bodies()) : 0);
}

std::uint64_t content_hash(Frames& frames) {
    const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(),
                                                                         &XXH3_freeState);
    if (!state)
        throw std::bad_alloc();
    XXH3_64bits_reset(state.get());
    const auto add = [&](std::span<const Aabb<float>> boxes) {
        XXH3_64bits_update(state.get(), boxes.data(), boxes.size_bytes());
    };
    frames.rewind();
    add(frames.start());
    while (const Frame* frame = frames.next())
        add(frame->boxes);
    frames.rewind();
    return XXH3_64bits_digest(state.get());
}

std::string params_json(const SceneFile& file) {
    std::string json =
        fmt::format(R"({{"frames_per_second":{},"groups":[)", file.frames_per_second);
    for (std::size_t g = 0; g < file.groups.size(); ++g) {
        const BodyGroup& group = file.groups[g];
        json += fmt::format(R"({}{{"generator":"{}","effects":[)", g ? "," : "", group.generator);
        for (std::size_t e = 0; e < group.effects.size(); ++e) {
            const EffectChoice& effect = group.effects[e];
            json += fmt::format(R"({}{{"name":"{}","share":{})", e ? "," : "", effect.name,
                                effect.share);
            for (const auto& [setting, value] : effect.settings)
                json += fmt::format(R"(,"{}":{})", setting,
                                    std::holds_alternative<std::string>(value)
                                        ? '"' + to_text(value) + '"'
                                        : to_text(value));
            json += "}";
        }
        json += "]}";
    }
    return json + "]}";
}

std::string effect_names(const SceneFile& file) {
    std::vector<std::string> names;
    for (const BodyGroup& group : file.groups)
        for (const EffectChoice& effect : group.effects)
            if (std::ranges::find(names, effect.name) == names.end())
                names.push_back(effect.name);
    return fmt::format("{}", fmt::join(names, ","));
}

std::string query_names(const SceneFile& file) {
    std::vector<std::string> names;
    for (const SceneQuery& query : file.queries)
        names.push_back(query.name);
    return fmt::format("{}", fmt::join(names, ","));
}

} // namespace boxwood
