#include "results/detail/ids.h"

#include "results/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <stdexcept>

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

/// visit(table, column, id, table of the ids) for every id of the results.
template <class Visit> void for_each_id(const Results& results, Visit&& visit) {
    for (const Table& table : tables())
        for (const Column& column : table.columns)
            if (const std::string_view ids_of = referred(column.name); !ids_of.empty()) {
                const auto rows = table.rows(results);
                for (std::size_t i = 0; i < rows.n; ++i)
                    visit(table, column.name, column.value<std::uint32_t>(rows[i]), ids_of);
            }
}

} // namespace

void require_valid_ids(const Results& results) {
    std::map<std::string_view, std::set<std::uint32_t>> ids;
    for_each_id(results, [&](const Table& table, std::string_view column, std::uint32_t id,
                             std::string_view ids_of) {
        if (ids_of == table.name && !ids[table.name].insert(id).second)
            fail(table.name, column, id, "which stands there twice");
    });
    for_each_id(results, [&](const Table& table, std::string_view column, std::uint32_t id,
                             std::string_view ids_of) {
        if (!ids[ids_of].contains(id) && !(table.is_derived && id == no_id))
            fail(table.name, column, id, fmt::format("which no row of {} has", ids_of));
    });
}

} // namespace boxwood::results::detail
