#include "bench/grading/grade.h"

#include "bench/commands/command.h"
#include "bench/io/json.h"
#include "trees/builder.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <memory>

namespace boxwood::bench {
namespace {

std::string json_of(const std::string& name, const Grade& g) {
    const auto counted = [](const Grade::Counted& c) {
        return fmt::format(R"({{"visits":{},"tests":{}}})", json_number(c.visits),
                           json_number(c.tests));
    };
    return fmt::format(R"({{"name":{},"nodes":{},"depth":{},"items_per_leaf":{},"sah":{},"epo":{},)"
                       R"("pairs":{},"points":{},"rays":{}}})",
                       json_string(name), g.n_nodes, g.depth, json_number(g.items_per_leaf),
                       json_number(g.sah()), json_number(g.epo), counted(g.pairs),
                       counted(g.points), counted(g.rays));
}

std::string line_of(const std::string& name, const Grade& g) {
    const auto counted = [](const Grade::Counted& c) {
        return fmt::format("{:.1f} + {:.1f}", c.visits, c.tests);
    };
    return fmt::format("{:<26} {:>9} {:>6} {:>6.2f} {:>9.2f} {:>8.3f} {:>18} {:>18} {:>18}\n", name,
                       g.n_nodes, g.depth, g.items_per_leaf, g.sah(), g.epo, counted(g.pairs),
                       counted(g.points), counted(g.rays));
}

int grade_file(const std::string& file, const std::string& table, bool as_json) {
    if (!table.empty() && std::filesystem::path(file).extension() == ".csv")
        throw BadInput(fmt::format("grade: --table is for HDF5 files, and {} is a CSV file", file));
    const NodeTable theirs = read_node_table(file, table.empty() ? "nodes" : table);
    if (const auto fault = fault_of(theirs)) {
        std::cout << (as_json ? fmt::format(R"({{"fault":{}}})"
                                            "\n",
                                            json_string(*fault))
                              : fmt::format("{}: no valid tree: {}\n", file, *fault));
        return 1;
    }
    std::vector<std::pair<std::string, Grade>> rows{{file, grade(theirs)}};
    for (const BuilderEntry& builder : builders()) {
        if (theirs.boxes().size() > 100'000 && builder.name == "incremental")
            continue; // minutes
        const Tree tree = make_builder(builder.name)(theirs.boxes(), serial());
        rows.emplace_back(builder.name, grade(NodeTable(tree, theirs.boxes())));
    }
    if (as_json) {
        std::string all;
        for (const auto& [name, g] : rows)
            all += (all.empty() ? "" : ",\n ") + json_of(name, g);
        std::cout << fmt::format("{{\"items\":{},\"trees\":[{}]}}\n", theirs.boxes().size(), all);
        return 0;
    }
    std::cout << fmt::format(
        "A valid tree of {} items. Beside it, ours of the same boxes; less is better.\n\n"
        "{:<26} {:>9} {:>6} {:>6} {:>9} {:>8} {:>18} {:>18} {:>18}\n",
        theirs.boxes().size(), "tree", "nodes", "depth", "leaf", "SAH", "EPO", "overlaps of a box",
        "boxes at a point", "boxes on a line");
    for (const auto& [name, g] : rows)
        std::cout << line_of(name, g);
    const std::size_t step = epo_step(theirs.boxes().size());
    std::cout << fmt::format(
        "\nSAH: nodes and items that a random line through the box of all items meets, areas over "
        "that of this box. EPO: item surface in nodes that the item "
        "is not below{}.\nThe last three: a mean query's visits to nodes + tests of boxes.\n",
        step > 1 ? fmt::format(" (one item in {})", step) : "");
    return 0;
}

} // namespace

void add_grade(CLI::App& app, int& exit_code) {
    auto file = std::make_shared<std::string>();
    auto table = std::make_shared<std::string>();
    auto as_json = std::make_shared<bool>(false);
    CLI::App* grade = app.add_subcommand(
        "grade", "how good anybody's tree is, beside ours on the same boxes, without a clock");
    grade
        ->add_option("tree", *file,
                     "CSV: node,parent,item,min_x,min_y,min_z,max_x,max_y,max_z a line; or HDF5: a "
                     "table with columns of these names. Of a node item is -1, of the root parent "
                     "is -1; of an item node is -1")
        ->required();
    grade->add_option("--table", *table, "the table of an HDF5 file; nodes if not said");
    grade->add_flag("--json", *as_json, "as one JSON object");
    grade->footer(
        "Example: boxwood grade my_tree.csv; boxwood grade mine.h5 --table frame_7/tree\n"
        "HDF5: a structured array of h5py, a DataFrame by to_hdf(FILE, key=\"nodes\", "
        "format=\"table\", data_columns=True), or a group with a dataset of each column.\n"
        "Exit codes: 0 a valid tree, 1 a node does not hold what is below it, 2 no tree.");
    grade->callback([=, &exit_code] { exit_code = grade_file(*file, *table, *as_json); });
}

} // namespace boxwood::bench
