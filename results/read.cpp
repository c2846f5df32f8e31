#include "results/detail/handle.h"
#include "results/detail/ids.h"
#include "results/detail/open.h"
#include "results/detail/seal.h"
#include "results/results.h"
#include "results/schema.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <span>
#include <utility>

namespace boxwood::results {
namespace {

using namespace detail;

namespace fs = std::filesystem;

[[noreturn]] void fail(std::string_view cause) { throw std::runtime_error(std::string(cause)); }

/// A scalar string, of fixed or variable length, of a dataset or an attribute.
template <class Read> std::string text_of(hid_t type, std::string_view name, Read&& read) {
    if (H5Tget_class(type) != H5T_STRING)
        fail(fmt::format("{} is not text", name));
    if (checked(H5Tis_variable_str(type), name) > 0) {
        char* pointer = nullptr;
        checked(read(type, &pointer), name);
        std::string value = pointer ? pointer : "";
        H5free_memory(pointer);
        return value;
    }
    std::string value(H5Tget_size(type), '\0');
    checked(read(type, value.data()), name);
    return value.substr(0, value.find('\0'));
}

void require_scalar(hid_t space, std::string_view name) {
    if (checked(H5Sget_simple_extent_npoints(space), name) != 1)
        fail(fmt::format("{} is not one value", name));
}

Handle open_attribute(hid_t file, const char* name) {
    Handle attribute(H5Aopen(file, name, H5P_DEFAULT), H5Aclose, name);
    require_scalar(Handle(H5Aget_space(attribute), H5Sclose, name), name);
    return attribute;
}

std::string text_attribute(hid_t file, const char* name) {
    const Handle attribute = open_attribute(file, name);
    const Handle type(H5Aget_type(attribute), H5Tclose, name);
    return text_of(type, name, [&](hid_t t, void* out) { return H5Aread(attribute, t, out); });
}

std::uint64_t integer_attribute(hid_t file, const char* name) {
    const Handle attribute = open_attribute(file, name);
    std::uint64_t value = 0;
    checked(H5Aread(attribute, H5T_NATIVE_UINT64, &value), name);
    return value;
}

bool has_attribute(hid_t file, const char* name) {
    return checked(H5Aexists(file, name), name) > 0;
}
bool has_link(hid_t group, const char* name) {
    return checked(H5Lexists(group, name, H5P_DEFAULT), name) > 0;
}

/// A column that the file has: where it stands in the records we ask HDF5 for.
struct Placed {
    const Column* column;
    std::size_t offset, size;
};

/// What to do about a file that lacks something.
std::string remedy(const fs::path& path, bool is_derived) {
    return is_derived ? fmt::format("`boxwood merge {} --out NEW.h5` derives it", path.string())
                      : "use another copy, or measure again";
}

/// The rows of a table, of the columns that we know.
struct Records {
    std::vector<Placed> columns;
    std::size_t n = 0, size = 0; ///< rows, bytes of each
    std::vector<std::byte> bytes;
};

/// Our type of a column; for a text the width that the file has.
Handle wanted_type(Stored stored, hid_t in_file, std::string_view where) {
    const H5T_class_t wanted = stored == Stored::text   ? H5T_STRING
                               : stored == Stored::real ? H5T_FLOAT
                                                        : H5T_INTEGER;
    if (H5Tget_class(in_file) != wanted)
        fail(fmt::format("column {} has the wrong type", where));
    if (stored != Stored::text)
        return number_type(stored, where);
    if (checked(H5Tis_variable_str(in_file), where) > 0)
        fail(fmt::format("column {} has strings of variable length", where));
    return string_type(H5Tget_size(in_file));
}

Records read_records(hid_t file, const fs::path& path, const Table& table, Required required,
                     std::uint64_t minor) {
    Records records;
    const std::string name(table.name);
    const Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, name);
    const Handle space(H5Dget_space(dataset), H5Sclose, name);
    const Handle in_file(H5Dget_type(dataset), H5Tclose, name);
    if (H5Tget_class(in_file) != H5T_COMPOUND || H5Sget_simple_extent_ndims(space) != 1)
        fail(fmt::format("{} is not a table", name));

    std::vector<Handle> types;
    for (const Column& column : table.columns) {
        const int index = H5Tget_member_index(in_file, std::string(column.name).c_str());
        const std::string where = fmt::format("{}.{}", name, column.name);
        if (index < 0 && required == Required::all && column.minor <= minor)
            fail(fmt::format("column {} is missing; {}", where,
                             remedy(path, table.is_derived || column.is_derived)));
        if (index < 0)
            continue;
        const Handle theirs(H5Tget_member_type(in_file, static_cast<unsigned>(index)), H5Tclose,
                            where);
        types.push_back(wanted_type(column.stored, theirs, where));
        records.columns.push_back({&column, records.size, H5Tget_size(types.back())});
        records.size += records.columns.back().size;
    }
    records.n = static_cast<std::size_t>(checked(H5Sget_simple_extent_npoints(space), name));
    if (records.n == 0 || types.empty())
        return records;
    const Handle record(H5Tcreate(H5T_COMPOUND, records.size), H5Tclose, name);
    for (std::size_t i = 0; i < types.size(); ++i)
        checked(H5Tinsert(record, std::string(records.columns[i].column->name).c_str(),
                          records.columns[i].offset, types[i]),
                name);
    records.bytes.resize(records.n * records.size);
    checked(H5Dread(dataset, record, H5S_ALL, H5S_ALL, H5P_DEFAULT, records.bytes.data()),
            fmt::format("table {}", name));
    return records;
}

void get_table(hid_t file, const fs::path& path, const Table& table, Required required,
               std::uint64_t minor, Results& results) {
    if (!has_link(file, std::string(table.name).c_str())) {
        if ((!table.is_derived || required == Required::all) && table.minor <= minor)
            fail(
                fmt::format("table {} is missing; {}", table.name, remedy(path, table.is_derived)));
        return;
    }
    const Records records = read_records(file, path, table, required, minor);
    table.resize(results, records.n);
    const auto rows = table.rows(results);
    for (const auto& [column, offset, size] : records.columns) {
        const std::byte* from = records.bytes.data() + offset;
        for (std::size_t i = 0; i < rows.n; ++i, from += records.size) {
            if (column->stored != Stored::text) {
                std::memcpy(rows[i] + column->at, from, size);
                continue;
            }
            const auto* start = reinterpret_cast<const char*>(from);
            const std::string_view text(start, strnlen(start, size));
            if (!column->set_text(rows[i], text))
                fail(fmt::format("column {}.{} holds the unknown word \"{}\"; use another copy, "
                                 "or measure again",
                                 table.name, column->name, text));
        }
    }
}

void get_texts(hid_t file, std::map<std::string, std::string>& texts) {
    if (!has_link(file, "text"))
        return;
    const Handle group(H5Gopen2(file, "text", H5P_DEFAULT), H5Gclose, "text");
    std::vector<std::string> names;
    const H5L_iterate_t take = [](hid_t, const char* name, const H5L_info_t*, void* out) -> herr_t {
        static_cast<std::vector<std::string>*>(out)->emplace_back(name);
        return 0;
    };
    checked(H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, take, &names), "text");
    for (const std::string& name : names) {
        const Handle dataset(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose, name);
        const Handle type(H5Dget_type(dataset), H5Tclose, name);
        require_scalar(Handle(H5Dget_space(dataset), H5Sclose, name), name);
        texts[name] = text_of(type, name, [&](hid_t t, void* out) {
            return H5Dread(dataset, t, H5S_ALL, H5S_ALL, H5P_DEFAULT, out);
        });
    }
}

/// NaN stands for a time that is missing.
void require_times(std::span<const Sample> samples) {
    for (std::size_t i = 0; i < samples.size(); ++i)
        if (const double ns = samples[i].wall_ns; ns <= 0 || std::isinf(ns))
            fail(fmt::format("column samples.wall_ns holds {:g} in row {}, which is no time; use "
                             "another copy, or measure again",
                             ns, i));
}

Results read_open(hid_t file, const fs::path& path, Required required) {
    if (!has_attribute(file, "format") || text_attribute(file, "format") != format_name)
        fail("an HDF5 file, but not a Boxwood result file (no attribute "
             "format=\"boxwood-results\")");
    const auto major = integer_attribute(file, "schema_major");
    if (major != schema_major)
        fail(fmt::format("it is of schema {}, and this program reads schema {}; measure again with "
                         "this version",
                         major, schema_major));
    if (!has_attribute(file, "complete") || integer_attribute(file, "complete") != 1)
        fail("it is incomplete: its writer did not finish");

    Results results;
    results.run_uuid = text_attribute(file, "run_uuid");
    results.created_utc = text_attribute(file, "created_utc");
    results.sweep_hash = text_attribute(file, "sweep_hash");
    results.generator = text_attribute(file, "generator");
    const auto minor = has_attribute(file, "schema_minor") ? integer_attribute(file, "schema_minor")
                                                           : schema_minor;
    for (const Table& table : tables())
        get_table(file, path, table, required, minor, results);
    require_valid_ids(results);
    require_times(results.samples);
    get_texts(file, results.texts);
    return results;
}

} // namespace

Results read(const fs::path& file, Required required) try {
    require_file(file);
    const SealState seal = state_of_seal(file);
    if (seal == SealState::broken)
        fail("it is damaged: its content is not what was written (checksum); use another copy");
    const Silence silence;
    const Handle handle = open_to_read(file);
    Results results = read_open(handle, file, required);
    results.is_sealed = seal == SealState::fits;
    return results;
} catch (const std::system_error& error) {
    throw std::runtime_error(
        fmt::format("cannot read result file '{}': {}", file.string(), error.code().message()));
} catch (const std::exception& error) {
    throw std::runtime_error(
        fmt::format("cannot read result file '{}': {}", file.string(), error.what()));
}

} // namespace boxwood::results
