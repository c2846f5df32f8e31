#pragma once

#include "trees/tree.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood::bench {

/// A tree of boxes of anybody's: nodes with any number of children, items below any node.
class NodeTable {
  public:
    struct Node {
        Box box;
        std::uint32_t first_child = 0, n_children = 0; ///< of children()
        std::uint32_t first_item = 0, n_items = 0;     ///< of items(): those of the node itself
    };

    /// A row of a table: a node with item == none, or an item with its box, below its parent.
    struct Row {
        static constexpr std::int64_t none = -1;
        std::int64_t node, parent, item;
        Box box;
        std::uint64_t number = 0;                            ///< of its row or line, for messages
        Aabb<double> given = static_cast<Aabb<double>>(box); ///< of which `box` is rounded
    };
    /// Node 0 is the root; children come after their parents. Throws BadInput for rows that are no
    /// tree: a node with two rows, a parent that is not there, no root or several, a circle.
    /// row_word: what its number counts, "row" or "line".
    explicit NodeTable(std::span<const Row> rows, std::string_view row_word = "row");
    /// Of ours: each leaf a node with its item.
    NodeTable(const Tree& tree, Boxes boxes);

    std::span<const Node> nodes() const { return nodes_; }
    std::span<const std::uint32_t> children(const Node& node) const {
        return {children_.data() + node.first_child, node.n_children};
    }
    std::span<const std::uint32_t> items(const Node& node) const {
        return {items_.data() + node.first_item, node.n_items};
    }
    /// Of the items, by number.
    std::span<const Box> boxes() const { return boxes_; }
    /// As they were given, of nodes and of items by number.
    std::span<const Aabb<double>> given_nodes() const { return given_nodes_; }
    std::span<const Aabb<double>> given_items() const { return given_items_; }
    /// How the node is called in the rows.
    std::int64_t name(std::size_t node) const {
        return names_.empty() ? static_cast<std::int64_t>(node) : names_[node];
    }

  private:
    std::vector<Node> nodes_;
    std::vector<std::int64_t> names_;
    std::vector<std::uint32_t> children_, items_;
    std::vector<Box> boxes_;
    std::vector<Aabb<double>> given_nodes_, given_items_;
};

/// The columns of a table of nodes: parent is -1 of the root, item -1 of nodes; the row of an item
/// has the number -1 for its node.
inline constexpr std::array<std::string_view, 9> node_columns{
    "node", "parent", "item", "min_x", "min_y", "min_z", "max_x", "max_y", "max_z"};

/// From the lines of a CSV file, or from the table `table` of an HDF5 file
/// (results/columns.h). Throws BadInput, which names the file and the row.
NodeTable read_node_table(const std::filesystem::path& file, const std::string& table = "nodes");

} // namespace boxwood::bench
