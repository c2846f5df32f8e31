#include "bench/grading/node_table.h"

#include "bench/io/bad_input.h"
#include "scenes/rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace boxwood::bench {

NodeTable::NodeTable(std::span<const Row> rows) {
    std::map<std::int64_t, std::vector<const Row*>> below; // by parent
    std::map<std::int64_t, const Row*> nodes;
    const Row* root = nullptr;
    std::size_t n_items = 0;
    for (const Row& row : rows) {
        if (row.item != Row::none) {
            ++n_items;
        } else {
            if (!nodes.try_emplace(row.node, &row).second)
                throw BadInput(fmt::format("node {} stands there twice", row.node));
            if (row.parent == Row::none) {
                if (root)
                    throw BadInput(
                        fmt::format("nodes {} and {} both have no parent; a tree has one "
                                    "root",
                                    root->node, row.node));
                root = &row;
                continue;
            }
        }
        below[row.parent].push_back(&row);
    }
    if (!root)
        throw BadInput("no node is the root: its parent is -1");
    for (const auto& [parent, of] : below)
        if (!nodes.contains(parent))
            throw BadInput(fmt::format("there is no node {}, the parent of {} {}", parent,
                                       of[0]->item == Row::none ? "node" : "item",
                                       of[0]->item == Row::none ? of[0]->node : of[0]->item));
    boxes_.resize(n_items);
    std::vector<bool> has_box(n_items);
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
                throw BadInput(fmt::format("item {} is none of the {} that are listed: items count "
                                           "from 0, each with one row",
                                           row->item, n_items));
            const auto item = static_cast<std::size_t>(row->item);
            if (has_box[item])
                throw BadInput(fmt::format("item {} stands there twice", item));
            has_box[item] = true;
            boxes_[item] = row->box;
            items_.push_back(static_cast<std::uint32_t>(item));
            ++node.n_items;
        }
        nodes_.push_back(node);
        names_.push_back(reached[i]->node);
    }
    if (nodes_.size() != nodes.size())
        throw BadInput(
            fmt::format("{} of {} nodes are not below the root: they go round in a circle",
                        nodes.size() - nodes_.size(), nodes.size()));
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
    }
}

NodeTable read_node_table(const std::filesystem::path& file) {
    std::vector<NodeTable::Row> rows;
    try {
        read_rows(
            file, "node,parent,item,min_x,min_y,min_z,max_x,max_y,max_z", 9, 9,
            [&](std::span<const double> row, const std::string& place) {
                std::int64_t whole[3];
                for (std::size_t i = 0; i < 3; ++i) {
                    if (!(row[i] >= -1 && row[i] < 0x1p31 && row[i] == std::floor(row[i])))
                        throw BadInput(fmt::format("{}: node, parent and item are whole "
                                                   "numbers from 0, or -1; {} is none",
                                                   place, row[i]));
                    whole[i] = static_cast<std::int64_t>(row[i]);
                }
                if ((whole[0] == -1) == (whole[2] == -1))
                    throw BadInput(fmt::format("{}: a row is of a node, with item -1, or of "
                                               "an item, with node -1",
                                               place));
                rows.push_back({whole[0], whole[1], whole[2], box_of(row.subspan<3, 6>(), place)});
            });
        return NodeTable(rows);
    } catch (const BadInput& error) {
        const std::string what = error.what();
        throw what.starts_with(file.string())
            ? error
            : BadInput(fmt::format("{}: {}", file.string(), what));
    } catch (const std::runtime_error& error) {
        throw BadInput(error.what());
    }
}

} // namespace boxwood::bench
