#include "bench/grading/node_table.h"

#include "bench/io/bad_input.h"
#include "results/columns.h"
#include "scenes/text/rows.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace boxwood::bench {

NodeTable::NodeTable(std::span<const Row> rows, std::string_view row_word) {
    std::map<std::int64_t, std::vector<const Row*>> below; // by parent
    std::map<std::int64_t, const Row*> nodes;
    const Row* root = nullptr;
    std::size_t n_items = 0;
    const auto twice = [&](std::string_view what, std::int64_t name, const Row& a, const Row& b) {
        return BadInput(fmt::format("{} {} has two rows, {}s {} and {}; give each {} one", what,
                                    name, row_word, std::min(a.number, b.number),
                                    std::max(a.number, b.number), what));
    };
    for (const Row& row : rows) {
        if (row.item != Row::none) {
            ++n_items;
        } else {
            if (const auto [same, is_new] = nodes.try_emplace(row.node, &row); !is_new)
                throw twice("node", row.node, *same->second, row);
            if (row.parent == Row::none) {
                if (root)
                    throw BadInput(fmt::format("nodes {} and {} ({}s {} and {}) both have no "
                                               "parent; a tree has one root",
                                               root->node, row.node, row_word, root->number,
                                               row.number));
                root = &row;
                continue;
            }
        }
        below[row.parent].push_back(&row);
    }
    if (!root)
        throw BadInput("no node is the root: give one the parent -1");
    for (const auto& [parent, of] : below) {
        const bool is_node = of[0]->item == Row::none;
        if (parent == Row::none)
            throw BadInput(fmt::format("item {} ({} {}) is below no node; give it a parent",
                                       of[0]->item, row_word, of[0]->number));
        if (!nodes.contains(parent))
            throw BadInput(fmt::format("there is no node {}, the parent of {} {} ({} {}); add its "
                                       "row, or name another parent",
                                       parent, is_node ? "node" : "item",
                                       is_node ? of[0]->node : of[0]->item, row_word,
                                       of[0]->number));
    }
    boxes_.resize(n_items);
    given_items_.resize(n_items);
    std::vector<const Row*> row_of(n_items);
    std::vector<const Row*> reached{root};
    for (std::size_t i = 0; i < reached.size(); ++i) { // breadth first
        Node node{reached[i]->box, static_cast<std::uint32_t>(children_.size()), 0,
                  static_cast<std::uint32_t>(items_.size()), 0};
        for (const Row* row : below[reached[i]->node]) {
            if (row->item == Row::none) {
                children_.push_back(static_cast<std::uint32_t>(reached.size()));
                reached.push_back(row);
                ++node.n_children;
                continue;
            }
            if (row->item < 0 || static_cast<std::size_t>(row->item) >= n_items)
                throw BadInput(fmt::format("item {} ({} {}) is none of the {} that are listed: "
                                           "items count from 0, each with one row",
                                           row->item, row_word, row->number, n_items));
            const auto item = static_cast<std::size_t>(row->item);
            if (row_of[item])
                throw twice("item", row->item, *row_of[item], *row);
            row_of[item] = row;
            boxes_[item] = row->box;
            given_items_[item] = row->given;
            items_.push_back(static_cast<std::uint32_t>(item));
            ++node.n_items;
        }
        nodes_.push_back(node);
        names_.push_back(reached[i]->node);
        given_nodes_.push_back(reached[i]->given);
    }
    if (nodes_.size() == nodes.size())
        return;
    for (const std::int64_t name : names_)
        nodes.erase(name);
    const Row& lost = *nodes.begin()->second;
    throw BadInput(fmt::format("node {} ({} {}) and {} more are not below the root: their parents "
                               "go round in a circle",
                               lost.node, row_word, lost.number, nodes.size() - 1));
}

NodeTable::NodeTable(const Tree& tree, Boxes boxes) : boxes_(boxes.begin(), boxes.end()) {
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        Node node{tree.bounds(i), static_cast<std::uint32_t>(children_.size()), 0,
                  static_cast<std::uint32_t>(items_.size()), 0};
        if (tree.is_leaf(i)) {
            items_.push_back(tree.item(i));
            node.n_items = 1;
        } else {
            for (const std::size_t child : {Tree::left(i), tree.right(i)})
                children_.push_back(static_cast<std::uint32_t>(child));
            node.n_children = 2;
        }
        nodes_.push_back(node);
        given_nodes_.push_back(static_cast<Aabb<double>>(node.box));
    }
    for (const Box& box : boxes_)
        given_items_.push_back(static_cast<Aabb<double>>(box));
}

namespace {

/// A row from its nine numbers.
NodeTable::Row row_of(std::span<const double> numbers, const std::string& place) {
    std::int64_t whole[3];
    for (std::size_t i = 0; i < 3; ++i) {
        if (!(numbers[i] >= -1 && numbers[i] < 0x1p53 && numbers[i] == std::floor(numbers[i])))
            throw BadInput(
                fmt::format("{}: {} is a whole number from 0 to below 2^53, or -1; {} is none",
                            place, node_columns[i], numbers[i]));
        whole[i] = static_cast<std::int64_t>(numbers[i]);
    }
    if ((whole[0] == -1) == (whole[2] == -1))
        throw BadInput(fmt::format("{}: a row is of a node, with item -1, or of an item, with node "
                                   "-1",
                                   place));
    const auto box = numbers.subspan<3, 6>();
    return {whole[0],           whole[1], whole[2],
            box_of(box, place), 0,        {{box[0], box[1], box[2]}, {box[3], box[4], box[5]}}};
}

NodeTable from_hdf5(const std::filesystem::path& file, const std::string& table) {
    const auto columns = results::read_columns(file, table, node_columns);
    std::vector<NodeTable::Row> rows;
    for (std::size_t i = 0; i < columns[0].size(); ++i) {
        std::array<double, node_columns.size()> numbers;
        for (std::size_t j = 0; j < numbers.size(); ++j)
            numbers[j] = columns[j][i];
        rows.push_back(row_of(numbers, fmt::format("{}: row {} of {}", file.string(), i, table)));
        rows.back().number = i;
    }
    if (rows.empty())
        throw BadInput(fmt::format("table {} has no rows", table));
    return NodeTable(rows);
}

NodeTable from_csv(const std::filesystem::path& file) {
    std::vector<NodeTable::Row> rows;
    const std::string columns = fmt::format("{}", fmt::join(node_columns, ","));
    read_rows(file, {columns, node_columns.size(), node_columns.size()},
              [&](std::span<const double> numbers, const std::string& place) {
                  rows.push_back(row_of(numbers, place));
                  rows.back().number = std::stoull(place.substr(place.rfind(':') + 1));
              });
    return NodeTable(rows, "line");
}

bool is_named_hdf5(const std::filesystem::path& file) {
    const std::filesystem::path ending = file.extension();
    return ending == ".h5" || ending == ".hdf5" || ending == ".hdf";
}

} // namespace

NodeTable read_node_table(const std::filesystem::path& file, const std::string& table) {
    try {
        return results::is_hdf5(file) || is_named_hdf5(file) ? from_hdf5(file, table)
                                                             : from_csv(file);
    } catch (const std::runtime_error& error) { // BadInput, too
        const std::string what = error.what();
        throw BadInput(
            what.starts_with(file.string()) ? what : fmt::format("{}: {}", file.string(), what));
    }
}

} // namespace boxwood::bench
