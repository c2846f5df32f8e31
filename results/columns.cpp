#include "results/columns.h"

#include "results/detail/open.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace boxwood::results {
namespace {

using namespace detail;

namespace fs = std::filesystem;

using Names = std::vector<std::string>;
using Numbers = std::vector<double>;

[[noreturn]] void fail(std::string_view cause) { throw std::runtime_error(std::string(cause)); }

Names links_of(hid_t group) {
    Names names;
    const H5L_iterate_t take = [](hid_t, const char* name, const H5L_info_t*, void* out) -> herr_t {
        static_cast<Names*>(out)->emplace_back(name);
        return 0;
    };
    checked(H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, take, &names), "its names");
    return names;
}

bool contains(const Names& names, std::string_view name) {
    return std::ranges::find(names, name) != names.end();
}

/// Of a table that lacks the column.
std::string lacks(const std::string& table, std::string_view column, const Names& has) {
    // pandas without data_columns=True, and in its format "fixed".
    const bool is_of_pandas = contains(has, "values_block_0") || contains(has, "block0_values");
    return fmt::format("table {} has no column {}; it has {}{}", table, column,
                       has.empty() ? "none" : fmt::format("{}", fmt::join(has, ", ")),
                       is_of_pandas ? "; pandas names columns by to_hdf(..., format=\"table\", "
                                      "data_columns=True)"
                                    : "");
}

void require_numbers(hid_t type, const std::string& table, std::string_view column) {
    const H5T_class_t kind = H5Tget_class(type);
    if (kind != H5T_INTEGER && kind != H5T_FLOAT)
        fail(fmt::format("column {} of table {} holds no numbers", column, table));
}

std::size_t rows_of(hid_t dataset, const std::string& what) {
    const Handle space(H5Dget_space(dataset), H5Sclose, what);
    if (H5Sget_simple_extent_ndims(space) != 1)
        fail(fmt::format("{} is not one-dimensional", what));
    return static_cast<std::size_t>(checked(H5Sget_simple_extent_npoints(space), what));
}

/// One column after another, so that a column takes no more than its numbers.
std::vector<Numbers> of_compound(hid_t dataset, const std::string& table,
                                 std::span<const std::string_view> columns) {
    const Handle in_file(H5Dget_type(dataset), H5Tclose, table);
    if (H5Tget_class(in_file) != H5T_COMPOUND)
        fail(fmt::format("{} is a dataset without named columns; make it a structured array",
                         table));
    Names has;
    for (int i = 0; i < H5Tget_nmembers(in_file); ++i) {
        char* name = H5Tget_member_name(in_file, static_cast<unsigned>(i));
        has.emplace_back(name ? name : "");
        H5free_memory(name);
    }
    std::vector<Numbers> numbers(columns.size());
    const std::size_t n = rows_of(dataset, fmt::format("table {}", table));
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const std::string name(columns[i]);
        const int index = H5Tget_member_index(in_file, name.c_str());
        if (index < 0)
            fail(lacks(table, name, has));
        require_numbers(
            Handle(H5Tget_member_type(in_file, static_cast<unsigned>(index)), H5Tclose, name),
            table, name);
        const Handle wanted(H5Tcreate(H5T_COMPOUND, sizeof(double)), H5Tclose, name);
        checked(H5Tinsert(wanted, name.c_str(), 0, H5T_NATIVE_DOUBLE), name);
        numbers[i].resize(n);
        checked(H5Dread(dataset, wanted, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers[i].data()), name);
    }
    return numbers;
}

std::vector<Numbers> of_group(hid_t group, const std::string& table,
                              std::span<const std::string_view> columns) {
    const Names has = links_of(group);
    std::vector<Numbers> numbers;
    for (const std::string_view column : columns) {
        const std::string name(column);
        if (!contains(has, name))
            fail(lacks(table, name, has));
        const Handle dataset(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose,
                             fmt::format("column {} of table {}", name, table));
        require_numbers(Handle(H5Dget_type(dataset), H5Tclose, name), table, name);
        Numbers& of = numbers.emplace_back(
            rows_of(dataset, fmt::format("column {} of table {}", name, table)));
        checked(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, of.data()),
                name);
        if (of.size() != numbers[0].size())
            fail(fmt::format("columns {} and {} of table {} have {} and {} rows", columns[0], name,
                             table, numbers[0].size(), of.size()));
    }
    return numbers;
}

/// False, too, if what is on the way is missing, or no group.
bool exists(hid_t file, const std::string& path) {
    for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
        if (H5Lexists(file, path.substr(0, end).c_str(), H5P_DEFAULT) <= 0)
            return false;
        if (end == std::string::npos)
            return H5Oexists_by_name(file, path.c_str(), H5P_DEFAULT) > 0;
    }
}

Handle open_object(hid_t in, const std::string& path) {
    return Handle(H5Oopen(in, path.c_str(), H5P_DEFAULT), H5Oclose, path);
}

std::vector<Numbers> of_table(hid_t file, const std::string& table,
                              std::span<const std::string_view> columns) {
    if (table.empty() || table == "/" || !exists(file, table)) {
        const Names has = links_of(file);
        fail(fmt::format("it has no table {}; it has {}", table,
                         has.empty() ? "none" : fmt::format("{}", fmt::join(has, ", "))));
    }
    const Handle object = open_object(file, table);
    if (H5Iget_type(object) == H5I_DATASET)
        return of_compound(object, table, columns);
    if (H5Iget_type(object) != H5I_GROUP)
        fail(fmt::format("{} is neither a dataset nor a group", table));
    if (exists(object, "table") && !exists(object, std::string(columns[0]))) { // of pandas
        const Handle inner = open_object(object, "table");
        if (H5Iget_type(inner) == H5I_DATASET)
            return of_compound(inner, table, columns);
    }
    return of_group(object, table, columns);
}

} // namespace

bool is_hdf5(const fs::path& file) {
    const Silence silence;
    std::error_code unreadable;
    return fs::is_regular_file(file, unreadable) && H5Fis_hdf5(file.c_str()) > 0;
}

std::vector<Numbers> read_columns(const fs::path& file, const std::string& table,
                                  std::span<const std::string_view> columns) try {
    require_file(file);
    const Silence silence;
    const Handle handle = open_to_read(file);
    return of_table(handle, table, columns);
} catch (const std::system_error& error) {
    throw std::runtime_error(fmt::format("{}: {}", file.string(), error.code().message()));
} catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("{}: {}", file.string(), error.what()));
}

} // namespace boxwood::results
