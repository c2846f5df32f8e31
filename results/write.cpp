#include "results/detail/handle.h"
#include "results/detail/seal.h"
#include "results/results.h"
#include "results/schema.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <span>
#include <system_error>

namespace boxwood::results {
namespace {

using namespace detail;

namespace fs = std::filesystem;

constexpr hsize_t rows_per_chunk = 4096;

[[noreturn]] void fail(std::string_view cause) { throw std::runtime_error(std::string(cause)); }

/// Bytes of a value in the file.
std::size_t size_in_file(const Column& column) {
    return column.stored == Stored::text ? column.width : column.size;
}

void encode_text(std::string_view table, const Column& column, std::string_view text,
                 std::byte* to) {
    if (text.size() > column.width)
        fail(fmt::format("{}.{}: \"{:.40}...\" has {} bytes, the column holds {}", table,
                         column.name, text, text.size(), column.width));
    if (const std::size_t zero = text.find('\0'); zero != text.npos)
        fail(fmt::format("{}.{}: \"{:.40}\" holds a zero byte", table, column.name,
                         text.substr(0, zero)));
    std::memcpy(to, text.data(), text.size());
}

/// The rows as the packed records of the dataset.
std::vector<std::byte> encode(const Table& table, std::size_t record_size, const Results& results) {
    const auto rows = table.rows(results);
    std::vector<std::byte> records(rows.n * record_size); // zero bytes pad the texts
    std::size_t offset = 0;
    for (const Column& column : table.columns) {
        std::byte* to = records.data() + offset;
        for (std::size_t i = 0; i < rows.n; ++i, to += record_size)
            if (column.stored == Stored::text)
                encode_text(table.name, column, column.text(rows[i]), to);
            else
                std::memcpy(to, rows[i] + column.at, column.size);
        offset += size_in_file(column);
    }
    return records;
}

void put_attribute(hid_t object, const char* name, hid_t type, const void* value) {
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose, name);
    const Handle attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose, name);
    checked(H5Awrite(attribute, type, value), name);
}

void put_text(hid_t object, const char* name, std::string_view value) {
    if (value.find('\0') != std::string_view::npos)
        fail(fmt::format("attribute {} holds a zero byte", name));
    const std::string terminated(value);
    const char* pointer = terminated.c_str();
    put_attribute(object, name, text_type(), &pointer);
}

/// {"column": "value", ...}; the texts of the schema need no escapes.
std::string json_of(const Table& table, std::string_view Column::*text) {
    std::string json;
    for (const Column& column : table.columns)
        json +=
            fmt::format("{}\"{}\": \"{}\"", json.empty() ? "{" : ", ", column.name, column.*text);
    return json + "}";
}

void put_table(hid_t file, const Table& table, const Results& results) {
    const std::string name(table.name);
    std::size_t record_size = 0;
    for (const Column& column : table.columns)
        record_size += size_in_file(column);
    const Handle type(H5Tcreate(H5T_COMPOUND, record_size), H5Tclose, name);
    std::size_t offset = 0;
    for (const Column& column : table.columns) {
        checked(H5Tinsert(type, std::string(column.name).c_str(), offset,
                          column.stored == Stored::text ? string_type(column.width)
                                                        : number_type(column.stored, name)),
                name);
        offset += size_in_file(column);
    }

    const hsize_t n = table.rows(results).n;
    const hsize_t unlimited = H5S_UNLIMITED;
    const hsize_t chunk = n == 0 ? rows_per_chunk : std::min(n, rows_per_chunk);
    const Handle space(H5Screate_simple(1, &n, &unlimited), H5Sclose, name);
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, name);
    checked(H5Pset_chunk(creation, 1, &chunk), name);
    checked(H5Pset_shuffle(creation), name);
    checked(H5Pset_deflate(creation, 6), name);
    checked(H5Pset_fletcher32(creation), name);
    checked(H5Pset_obj_track_times(creation, false), name);
    const Handle dataset(
        H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose,
        name);
    if (n > 0)
        checked(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                         encode(table, record_size, results).data()),
                name);
    put_text(dataset, "summary", table.summary);
    put_text(dataset, "units", json_of(table, &Column::unit));
    put_text(dataset, "columns", json_of(table, &Column::summary));
}

void put_texts(hid_t file, const std::map<std::string, std::string>& texts) {
    const Handle group(H5Gcreate2(file, "text", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose,
                       "text");
    const Handle type = text_type();
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "text");
    for (const auto& [name, value] : texts) {
        if (name.empty() || name == "." ||
            name.find_first_of(std::string_view("/\0", 2)) != name.npos)
            fail(fmt::format("text: \"{}\" cannot be the name of a text", name));
        if (value.find('\0') != std::string::npos)
            fail(fmt::format("text/{} holds a zero byte", name));
        const Handle dataset(
            H5Dcreate2(group, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
            H5Dclose, name);
        const char* pointer = value.c_str();
        checked(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &pointer), name);
    }
}

/// A file descriptor; closes on destruction, unless closed before. Failures throw system_error.
class Descriptor {
  public:
    explicit Descriptor(int fd) : fd_(fd) { require(fd >= 0); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (fd_ >= 0)
            ::close(fd_);
    }
    void write(std::span<const std::byte> bytes) {
        while (!bytes.empty()) {
            const ssize_t n = ::write(fd_, bytes.data(), bytes.size());
            if (n < 0 && errno == EINTR)
                continue;
            require(n >= 0);
            bytes = bytes.subspan(static_cast<std::size_t>(n));
        }
    }
    void sync() { require(::fsync(fd_) == 0 || errno == EINVAL); } // EINVAL: nothing to sync
    void close() { require(::close(std::exchange(fd_, -1)) == 0); }

  private:
    static void require(bool fine) {
        if (!fine)
            throw std::system_error(errno, std::generic_category());
    }
    int fd_;
};

/// Takes over the memory of a closed HDF5 file of the core driver. (H5Fget_file_image of 1.10.8
/// gives a copy of the open file whose superblock has a wrong checksum.)
class Image {
  public:
    explicit Image(hid_t access) {
        H5FD_file_image_callbacks_t callbacks{};
        callbacks.image_malloc = [](std::size_t size, H5FD_file_image_op_t op, void* self) {
            return resize(nullptr, size, op, self);
        };
        callbacks.image_memcpy = [](void* to, const void* from, std::size_t size,
                                    H5FD_file_image_op_t,
                                    void*) { return std::memcpy(to, from, size); };
        callbacks.image_realloc = resize;
        callbacks.image_free = [](void* data, H5FD_file_image_op_t op, void*) -> herr_t {
            if (op != H5FD_FILE_IMAGE_OP_FILE_CLOSE)
                std::free(data);
            return 0;
        };
        callbacks.udata_copy = [](void* self) { return self; };
        callbacks.udata_free = [](void*) -> herr_t { return 0; };
        callbacks.udata = this;
        checked(H5Pset_file_image_callbacks(access, &callbacks), "file in memory");
    }
    Image(const Image&) = delete;
    Image& operator=(const Image&) = delete;
    ~Image() { std::free(data_); }
    std::span<const std::byte> bytes() const { return {static_cast<std::byte*>(data_), size_}; }

  private:
    static void* resize(void* data, std::size_t size, H5FD_file_image_op_t, void* self) {
        auto& image = *static_cast<Image*>(self);
        void* const resized = std::realloc(data, size);
        if (resized) {
            image.data_ = resized;
            image.size_ = size;
        }
        return resized;
    }
    void* data_ = nullptr;
    std::size_t size_ = 0;
};

/// Makes the HDF5 file in the memory of `access`: HDF5 defers writes until a file is closed, and
/// does not get over one that fails (a full disk) then.
void write_image(const Results& results, hid_t access) {
    // The format of HDF5 1.10 guards all metadata by checksums.
    checked(H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110), "file format");
    Handle file(H5Fcreate("results in memory", H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose,
                "new file");
    put_text(file, "format", format_name);
    put_attribute(file, "schema_major", H5T_NATIVE_UINT32, &schema_major);
    put_attribute(file, "schema_minor", H5T_NATIVE_UINT32, &schema_minor);
    put_text(file, "run_uuid", results.run_uuid);
    put_text(file, "created_utc", results.created_utc);
    put_text(file, "sweep_hash", results.sweep_hash);
    put_text(file, "generator", results.generator);
    for (const Table& table : tables())
        put_table(file, table, results);
    put_texts(file, results.texts);
    const std::uint32_t complete = results.complete;
    put_attribute(file, "complete", H5T_NATIVE_UINT32, &complete);
    file.close("closing the file");
}

/// Replaces `file` by the content, as a whole or not at all.
void replace(const fs::path& file, std::span<const std::byte> content, bool is_sealed) {
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    if (!fs::exists(folder))
        fail(fmt::format("the folder '{}' does not exist; create it first", folder.string()));
    if (fs::exists(file) && !fs::is_regular_file(file))
        fail("it exists and is not a regular file; choose another name");
    const fs::path temporary = file.string() + fmt::format(".tmp-{}", ::getpid());
    try {
        Descriptor out(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
        Seal seal;
        seal.add(content);
        out.write(content);
        if (is_sealed)
            out.write(seal.bytes());
        out.sync();
        out.close();
        fs::rename(temporary, file);
    } catch (...) {
        std::error_code ignored;
        fs::remove(temporary, ignored);
        throw;
    }
    Descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)).sync();
}

} // namespace

void write(const fs::path& file, const Results& results) try {
    const Silence silence;
    constexpr std::size_t growth = 1; // byte: the file is not padded
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "file access");
    checked(H5Pset_fapl_core(access, growth, /*backing_store=*/false), "file access");
    const Image image(access);
    write_image(results, access);
    replace(fs::exists(file) ? fs::canonical(file) : file, image.bytes(),
            results.is_sealed); // a link stays a link
} catch (const std::system_error& error) {
    throw std::runtime_error(
        fmt::format("cannot write result file '{}': {}", file.string(), error.code().message()));
} catch (const std::exception& error) {
    throw std::runtime_error(
        fmt::format("cannot write result file '{}': {}", file.string(), error.what()));
}

} // namespace boxwood::results
