#include "results/columns.h"

#include "results/detail/handle.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <fstream>

namespace boxwood::results {
namespace {

using namespace detail;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 2> id_and_size{"id", "size"};

class Columns : public testing::Test {
  protected:
    Columns()
        : folder_(fs::temp_directory_path() /
                  (std::string("boxwood_columns_") + std::to_string(::getpid()))),
          file_(folder_ / "theirs.h5") {
        fs::create_directories(folder_);
    }
    ~Columns() override { fs::remove_all(folder_); }

    Handle create() const {
        return Handle(H5Fcreate(file_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose,
                      "create");
    }

    static void put(hid_t in, const char* name, hid_t type, const std::vector<hsize_t>& shape,
                    const void* values) {
        const Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                           H5Sclose, name);
        const Handle dataset(
            H5Dcreate2(in, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose,
            name);
        checked(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), name);
    }

    static Handle group(hid_t in, const char* name) {
        return Handle(H5Gcreate2(in, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, name);
    }

    /// A compound dataset of columns size, word and id, in that order.
    static void put_compound(hid_t in, const char* name) {
        struct Row {
            float size;
            std::array<char, 4> word;
            std::int16_t id;
        };
        const std::array<Row, 2> rows{{{1.5f, {"abc"}, -1}, {-2, {"de"}, 300}}};
        const Handle word = string_type(4);
        const Handle type(H5Tcreate(H5T_COMPOUND, sizeof(Row)), H5Tclose, name);
        checked(H5Tinsert(type, "size", offsetof(Row, size), H5T_NATIVE_FLOAT), name);
        checked(H5Tinsert(type, "word", offsetof(Row, word), word), name);
        checked(H5Tinsert(type, "id", offsetof(Row, id), H5T_NATIVE_INT16), name);
        put(in, name, type, {rows.size()}, rows.data());
    }

    std::string complaint(const std::string& table,
                          std::span<const std::string_view> columns = id_and_size) const {
        try {
            read_columns(file_, table, columns);
        } catch (const std::runtime_error& error) {
            EXPECT_THAT(error.what(), StartsWith(file_.string() + ": "));
            return error.what();
        }
        return "";
    }

    fs::path folder_, file_;
};

void expect_both_rows(const std::vector<std::vector<double>>& read) {
    ASSERT_EQ(read.size(), 2u);
    EXPECT_THAT(read[0], ElementsAre(-1, 300));
    EXPECT_THAT(read[1], ElementsAre(1.5, -2));
}

TEST_F(Columns, OfACompound) {
    {
        const Handle file = create(), deep = group(file, "deep");
        put_compound(deep, "rows");
    }
    EXPECT_TRUE(is_hdf5(file_));
    expect_both_rows(read_columns(file_, "deep/rows", id_and_size));
    expect_both_rows(read_columns(file_, "/deep/rows", id_and_size));
}

TEST_F(Columns, OfAGroupAndOfPandas) {
    {
        const Handle file = create(), apart = group(file, "apart"), pandas = group(file, "pandas");
        const std::array<std::uint64_t, 2> ids{7, 0};
        const std::array<double, 2> sizes{1, 2};
        put(apart, "id", H5T_NATIVE_UINT64, {2}, ids.data());
        put(apart, "size", H5T_NATIVE_DOUBLE, {2}, sizes.data());
        put_compound(pandas, "table");
    }
    const auto read = read_columns(file_, "apart", id_and_size);
    EXPECT_THAT(read[0], ElementsAre(7, 0));
    EXPECT_THAT(read[1], ElementsAre(1, 2));
    expect_both_rows(read_columns(file_, "pandas", id_and_size));
}

TEST_F(Columns, WhatIsNoneIsRefused) {
    {
        const Handle file = create(), uneven = group(file, "uneven"), flat = group(file, "flat"),
                     self = group(file, "self"), old = group(file, "old");
        const std::array<double, 4> numbers{1, 2, 3, 4};
        put_compound(file, "rows");
        put(file, "bare", H5T_NATIVE_DOUBLE, {4}, numbers.data());
        put(uneven, "id", H5T_NATIVE_DOUBLE, {4}, numbers.data());
        put(uneven, "size", H5T_NATIVE_DOUBLE, {3}, numbers.data());
        put(flat, "id", H5T_NATIVE_DOUBLE, {2, 2}, numbers.data());
        put(flat, "size", H5T_NATIVE_DOUBLE, {4}, numbers.data());
        put(old, "block0_values", H5T_NATIVE_DOUBLE, {4}, numbers.data());
        checked(H5Lcreate_hard(file, "self", self, "table", H5P_DEFAULT, H5P_DEFAULT), "cycle");
    }
    EXPECT_THAT(complaint("row"),
                HasSubstr("it has no table row; it has bare, flat, old, rows, self, uneven"));
    EXPECT_THAT(complaint("none/of/these"), HasSubstr("it has no table none/of/these"));
    EXPECT_THAT(complaint("/"), HasSubstr("it has no table /"));
    EXPECT_THAT(complaint(""), HasSubstr("it has no table"));
    EXPECT_THAT(complaint("rows/id"), HasSubstr("no table rows/id"));
    EXPECT_THAT(complaint("bare"), HasSubstr("without named columns"));
    EXPECT_THAT(complaint("uneven"), HasSubstr("columns id and size of table uneven have 4 and 3"));
    EXPECT_THAT(complaint("flat"), HasSubstr("column id of table flat is not one-dimensional"));
    EXPECT_THAT(complaint("self"), HasSubstr("table self has no column id; it has table"));
    EXPECT_THAT(complaint("old"), AllOf(HasSubstr("no column id"), HasSubstr("data_columns=True")));
    const std::array<std::string_view, 1> word{"word"}, absent{"words"};
    EXPECT_THAT(complaint("rows", word), HasSubstr("column word of table rows holds no numbers"));
    EXPECT_THAT(complaint("rows", absent),
                HasSubstr("table rows has no column words; it has size, word, id"));
}

TEST_F(Columns, BadFilesAreRefused) {
    EXPECT_FALSE(is_hdf5(file_));
    EXPECT_FALSE(is_hdf5(folder_));
    EXPECT_THAT(complaint("rows"), HasSubstr("no such file"));
    std::ofstream(file_) << "";
    EXPECT_THAT(complaint("rows"), HasSubstr("the file is empty"));
    std::ofstream(file_) << "node,parent\n";
    EXPECT_FALSE(is_hdf5(file_));
    EXPECT_THAT(complaint("rows"), HasSubstr("not an HDF5 file"));
    {
        const Handle file = create();
        put_compound(file, "rows");
    }
    fs::resize_file(file_, fs::file_size(file_) / 2);
    EXPECT_THAT(complaint("rows"), HasSubstr("not a readable HDF5 file"));
}

} // namespace
} // namespace boxwood::results
