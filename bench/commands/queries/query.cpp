#include "bench/commands/queries/query.h"

#include "bench/commands/command.h"
#include "kernels/suggest.h"
#include "trees/world/bodies/robot_meshes.h"

#include <CLI/CLI.hpp>

#include <charconv>
#include <thread>
#include <vector>

namespace boxwood::bench {
namespace {

constexpr unsigned max_threads = 1024;
constexpr std::size_t block_bytes = std::size_t{1} << 20;

} // namespace

void add_tree_options(CLI::App& app, TreeChoice& choice, const std::string& effect_on_answers) {
    const std::string group = "Tree and threads (" + effect_on_answers + ")";
    app.add_option("--builder", choice.builder, "a name of `boxwood list builders`")
        ->capture_default_str()
        ->group(group);
    app.add_option("--layout", choice.layout, "a name of `boxwood list layouts`")
        ->capture_default_str()
        ->group(group);
    app.add_option("--executor", choice.executor, "a name of `boxwood list executors`")
        ->capture_default_str()
        ->group(group);
    app.add_option("--threads", choice.threads, "number of threads; as many as cores if not given")
        ->check(CLI::Range(1u, max_threads))
        ->group(group);
}

BuildFunction chosen_builder(const TreeChoice& choice) {
    try {
        return make_builder(choice.builder);
    } catch (const std::invalid_argument& error) {
        throw BadInput(error.what());
    }
}

const LayoutEntry& chosen_layout(const TreeChoice& choice) {
    try {
        return find_layout(choice.layout);
    } catch (const std::invalid_argument& error) {
        throw BadInput(error.what());
    }
}

std::unique_ptr<Executor> chosen_executor(const TreeChoice& choice) {
    const auto entry = std::ranges::find(executors(), choice.executor, &ExecutorEntry::name);
    if (entry == executors().end())
        throw BadInput(unknown_name("executor", choice.executor, names_of(executors())));
    const unsigned all = std::clamp(std::thread::hardware_concurrency(), 1u,
                                    std::min(max_threads, entry->max_threads));
    return make_executor(choice.executor, choice.threads.value_or(all));
}

void add_format_options(CLI::App& app, Format& format) {
    auto* header = app.add_flag("--header", format.header, "print a line of column names first");
    app.add_flag("--json", format.json, "print one JSON object instead of lines")->excludes(header);
}

BlockWriter& BlockWriter::operator<<(std::string_view text) {
    block_ += text;
    if (block_.size() >= block_bytes)
        flush();
    return *this;
}

BlockWriter& BlockWriter::operator<<(std::uint32_t number) {
    char digits[16];
    return *this << std::string_view(digits,
                                     std::to_chars(digits, digits + sizeof digits, number).ptr);
}

BlockWriter& BlockWriter::operator<<(float number) {
    char digits[32];
    return *this << std::string_view(digits,
                                     std::to_chars(digits, digits + sizeof digits, number).ptr);
}

void BlockWriter::flush() {
    out_.write(block_.data(), static_cast<std::streamsize>(block_.size()));
    block_.clear();
}

void add_query(CLI::App& app, int&) {
    CLI::App* query =
        app.add_subcommand("query", "answer a question about your own boxes, meshes or triangles");
    query->require_subcommand(1);
    query->footer("Answers go to stdout, one line per item; everything else goes to stderr.\n\n"
                  "Examples:\n"
                  "  boxwood query pairs boxes.csv\n"
                  "  boxwood query rays model.obj rays.csv");
    add_query_pairs(*query);
    add_query_rays(*query);
    add_query_triangles(*query);
    add_query_ccd(*query);
    add_query_meshes(*query);
    add_query_continuous(*query);
    add_query_robot(
        *query, [](const Robot& robot, std::span<const TriangleMesh> meshes, bool are_solid) {
            return std::make_unique<RobotMeshes>(robot, meshes, RobotMeshesOptions{are_solid});
        });
}

} // namespace boxwood::bench
