#include "bench/analysis/analyse.h"
#include "bench/commands/command.h"
#include "bench/io/read_results.h"
#include "results/results.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

namespace boxwood::bench {
namespace {

namespace fs = std::filesystem;

void merge_files(const std::vector<std::string>& files, const std::string& out) {
    std::vector<results::Results> parts;
    for (const std::string& file : files) {
        std::error_code ignored; // neither file need exist
        if (fs::equivalent(file, out, ignored) || fs::path(file) == fs::path(out))
            throw BadInput(fmt::format(
                "merge: '{}' is an input and the output; give --out another name", file));
        parts.push_back(read_results(file, results::Required::measured));
    }
    results::Results merged = results::merge(parts, files);
    analyse(merged, delta_of(parts)); // from the samples of all parts
    results::write(out, merged);
    std::cout << fmt::format("{}: machine states {}, shards {}, cells {}, samples {}\n", out,
                             merged.env.size(), merged.shards.size(), merged.cells.size(),
                             merged.samples.size());
}

} // namespace

void add_merge(CLI::App& app, int&) {
    auto files = std::make_shared<std::vector<std::string>>();
    auto out = std::make_shared<std::string>();
    CLI::App* merge = app.add_subcommand(
        "merge", "join result files, also from several machines of one processor model");
    merge->add_option("files", *files, "result files (HDF5)")->required();
    merge->add_option("--out", *out, "the file to write; none of the inputs")->required();
    merge->footer("Example: boxwood merge monday.h5 tuesday.h5 --out both.h5\n"
                  "Rounds that stand in several files are kept once.");
    merge->callback([files, out] { merge_files(*files, *out); });
}

} // namespace boxwood::bench
