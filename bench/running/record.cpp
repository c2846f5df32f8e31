#include "bench/running/record.h"

#include "bench/machine/environment.h"
#include "scenes/human_name.h"
#include "scenes/moving/frames.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <random>

namespace boxwood::bench {
namespace {

std::string random_uuid() {
    std::random_device device;
    const auto bits = [&](unsigned mask, unsigned set) { return (device() & mask) | set; };
    return fmt::format("{:08x}-{:04x}-{:04x}-{:04x}-{:08x}{:04x}", bits(~0u, 0), bits(0xffff, 0),
                       bits(0x0fff, 0x4000), bits(0x3fff, 0x8000), bits(~0u, 0), bits(0xffff, 0));
}

std::string name_without_rays(SceneSpec spec) {
    spec.rays.clear();
    return human_name(spec);
}

/// What one use of a task costs.
struct Total {
    results::Phase phase;
    const char* title;
};

Total total_of(Phases phases) {
    switch (phases) {
    case Phases::build:
        return {results::Phase::build, "build"};
    case Phases::query:
        return {results::Phase::query, "query"};
    case Phases::frames:
        return {results::Phase::update_and_query, "update and query of a frame"};
    case Phases::build_and_query:
        break;
    }
    return {results::Phase::build_and_query, "build and one query"};
}

std::vector<std::string> all_with(std::vector<std::string> classes, const std::string& suffix) {
    if (classes.empty())
        classes = {""};
    for (std::string& name : classes)
        name += (name.empty() ? "" : " ") + suffix;
    return classes;
}

/// Contenders that are held to an instruction set stand apart.
std::vector<std::string> classes_on(const std::string& isa, std::vector<std::string> classes) {
    return isa.empty() ? classes : all_with(std::move(classes), "on " + isa);
}

/// Contenders on a device stand apart, and those that leave their answers there from the others.
std::vector<std::string> classes_at(std::string_view place, std::vector<std::string> classes) {
    if (!is_device(place))
        return classes;
    return all_with(std::move(classes), place == device_executor  ? "on a device"
                                        : place == graph_executor ? "resident by a graph"
                                                                  : "resident");
}

} // namespace

Record::Record(const results::Env& env, std::string generator) {
    out.run_uuid = random_uuid();
    out.created_utc =
        fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::now()));
    out.generator = std::move(generator);
    out.env.push_back(env);
    out.packages = package_rows();
}

std::uint32_t Record::add_scene(const Scene& scene, std::string tasks) {
    results::SceneRow row;
    row.scene_id = static_cast<std::uint32_t>(out.scenes.size());
    row.name = scene.name;
    row.human_name = name_without_rays(scene.spec);
    row.rays = scene.spec.rays;
    row.generator = scene.spec.generator;
    row.n_items = items_of(scene);
    row.n_triangles = scene.mesh.triangles.size();
    if (scene.spec.moving) {
        row.n_frames = scene.spec.moving->frames;
        row.effects = effect_names(*scene.spec.moving);
    }
    row.seed = scene.spec.seed;
    row.queries = std::move(tasks);
    if (scene.spec.moving)
        row.queries += ',' + query_names(*scene.spec.moving);
    const SceneSpec& spec = scene.spec;
    if (spec.moving) {
        row.source = spec.moving->source;
        row.licence = spec.moving->licence;
    } else if (!spec.file.empty()) {
        row.source = spec.file.filename().string(); // the user's own
    } else {
        row.source = "Boxwood";
        row.licence = "Apache-2.0";
    }
    row.content_hash = scene.content_hash;
    row.params_json = scene.params_json;
    out.scenes.push_back(row);
    return row.scene_id;
}

results::Cell Record::cell(std::string name, const Job& job, std::uint32_t scene_id,
                           const ContenderEntry& contender) {
    const Task& task = *job.task;
    if (std::ranges::find(out.tasks, task.name(), &results::TaskRow::task) == out.tasks.end())
        out.tasks.push_back(task_row(task));
    results::Cell row;
    row.cell_id = static_cast<std::uint32_t>(out.cells.size());
    row.name = std::move(name);
    row.scene_id = scene_id;
    row.variant_id = variant_id_of(contender);
    row.task = task.name();
    row.classes = classes_text(job, contender.classes);
    row.n_items = items_of(*job.scene);
    row.n_queries = task.n_queries(*job.scene);
    row.precision = contender.precision;
    row.executor = job.executor;
    row.threads = job.threads;
    if (!job.isa.empty())
        row.isa = job.isa;
    else if (!contender.is_peer && !is_device(job.executor))
        row.isa = out.env.front().isa_used;
    return row;
}

std::string Record::classes_text(const Job& job, const std::vector<std::string>& classes) {
    return fmt::format("{}",
                       fmt::join(classes_on(job.isa, classes_at(job.executor, classes)), ","));
}

void Record::add(Judgement judgement, std::uint32_t cell_id, double query_ns) {
    judgement.check.cell_id = cell_id;
    judgement.check.status = judgement.status;
    if (judgement.kernel) {
        results::KernelRow& row = *judgement.kernel;
        row.cell_id = cell_id;
        if (const std::string& place = out.cells.at(cell_id).executor; is_device(place))
            row.kernel += " " + classes_at(place, {}).front();
        row.status = judgement.check.status;
        if (judgement.calls > 0)
            row.ns_per_call = query_ns / static_cast<double>(judgement.calls);
        out.kernels.push_back(std::move(row));
    }
    for (results::ConditionRow& row : judgement.conditions) {
        row.cell_id = cell_id;
        out.conditions.push_back(row);
    }
    out.checks.push_back(std::move(judgement.check));
}

std::uint32_t Record::variant_id_of(const ContenderEntry& contender) {
    for (const results::Variant& variant : out.variants)
        if (variant.name == contender.name && variant.library == contender.library &&
            variant.params_json == contender.params_json)
            return variant.variant_id;
    results::Variant row;
    row.variant_id = static_cast<std::uint32_t>(out.variants.size());
    row.name = contender.name;
    row.library = contender.library;
    const auto peer = std::ranges::find(peers(), contender.library, &Peer::name);
    const bool is_ours = peer == peers().end();
    row.library_title = is_ours ? "Boxwood" : peer->title;
    row.lib_version = is_ours ? out.env.front().git_commit : peer->version;
    row.builder = contender.builder;
    row.layout = contender.layout;
    row.traversal = contender.traversal;
    row.kernel = contender.kernel;
    if (contender.promise != Promise::none)
        row.predicates = to_string(contender.promise);
    row.is_peer = contender.is_peer;
    row.is_reference = contender.is_reference;
    row.place = static_cast<std::uint32_t>(is_ours ? contender.place : peer->place);
    row.is_plain = contender.is_plain;
    row.answers_from_cache = contender.answers_from_cache;
    row.keeps_structure = contender.keeps_structure;
    row.stages = contender.stages;
    row.params_json = contender.params_json;
    row.notes = contender.notes;
    out.variants.push_back(row);
    return row.variant_id;
}

results::TaskRow task_row(const Task& task) {
    const Total total = total_of(task.phases());
    return {std::string(task.name()), task.title(), total.phase, total.title};
}

std::uint64_t items_of(const Scene& scene) {
    const std::size_t cases = n_cases(scene.cases);
    return cases > 0 ? cases : scene.boxes.size();
}

KeepFloatingPointMode::KeepFloatingPointMode() { std::fegetenv(&saved_); }
KeepFloatingPointMode::~KeepFloatingPointMode() { std::fesetenv(&saved_); }

} // namespace boxwood::bench
