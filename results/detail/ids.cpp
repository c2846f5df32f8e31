#include "results/detail/ids.h"

#include "results/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <stdexcept>
#include <type_traits>

namespace boxwood::results::detail {
namespace {

/// The table whose rows the column names; empty if it holds no ids.
std::string_view referred(std::string_view column) {
    const auto* const found = std::ranges::find(references, column, &Reference::column);
    return found == std::end(references) ? "" : found->table;
}

[[noreturn]] void fail(std::string_view table, std::string_view column, std::uint32_t id,
                       std::string_view problem) {
    throw std::runtime_error(
        fmt::format("column {}.{} holds {}, {}; use another copy, or measure again", table, column,
                    id, problem));
}

/// visit(column name, member, table of the ids) for every column of ids.
template <class Row, class Visit> void for_each_id(const Table<Row>& table, Visit&& visit) {
    for (const auto& column : table.columns)
        if (const auto* member = std::get_if<std::uint32_t Row::*>(&column.member))
            if (const std::string_view ids_of = referred(column.name); !ids_of.empty())
                visit(column.name, *member, ids_of);
}

} // namespace

void require_valid_ids(const Results& results) {
    std::map<std::string_view, std::set<std::uint32_t>> ids;
    for_each_table([&]<class Row>(const Table<Row>& table) {
        for_each_id(table, [&](std::string_view column, auto member, std::string_view ids_of) {
            if (ids_of != table.name)
                return;
            for (const Row& row : results.*table.rows)
                if (!ids[table.name].insert(row.*member).second)
                    fail(table.name, column, row.*member, "which stands there twice");
        });
    });
    for_each_table([&]<class Row>(const Table<Row>& table) {
        for_each_id(table, [&](std::string_view column, auto member, std::string_view ids_of) {
            for (const Row& row : results.*table.rows)
                if (!ids[ids_of].contains(row.*member) &&
                    !(table.is_derived && row.*member == no_id))
                    fail(table.name, column, row.*member,
                         fmt::format("which no row of {} has", ids_of));
        });
    });
}

} // namespace boxwood::results::detail
