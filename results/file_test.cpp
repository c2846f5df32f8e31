#include "results/detail/handle.h"
#include "results/results.h"
#include "results/testing/example.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>

namespace boxwood::results {
namespace {

using namespace detail;

namespace fs = std::filesystem;

std::string bytes_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

void put_bytes(const fs::path& file, std::string_view bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

class ResultFile : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() /
                  (std::string("boxwood_results_") + std::to_string(::getpid()));
        fs::create_directories(folder_);
        file_ = folder_ / "a.h5";
    }
    void TearDown() override { fs::remove_all(folder_); }

    /// What the reader says of the file; "" if it takes it.
    static std::string complaint(const fs::path& file) {
        try {
            read(file);
        } catch (const std::runtime_error& error) {
            EXPECT_NE(std::string(error.what()).find(file.string()), std::string::npos);
            return error.what();
        }
        return "";
    }
    static std::string complaint(const fs::path& file, const Results& results) {
        try {
            write(file, results);
        } catch (const std::runtime_error& error) {
            EXPECT_NE(std::string(error.what()).find(file.string()), std::string::npos);
            return error.what();
        }
        return "";
    }
    std::size_t files_in_folder() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator{}));
    }
    /// Opens the file with HDF5 for a change by hand.
    template <class Change> void change(Change&& change) const {
        const Handle file(H5Fopen(file_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose, "open");
        change(file);
    }
    void set_attribute(const char* name, std::uint32_t value) const {
        change([&](hid_t file) {
            const Handle attribute(H5Aopen(file, name, H5P_DEFAULT), H5Aclose, name);
            checked(H5Awrite(attribute, H5T_NATIVE_UINT32, &value), name);
        });
    }

    fs::path folder_, file_;
};

#define EXPECT_SAYS(text, part) EXPECT_NE((text).find(part), std::string::npos) << text

TEST_F(ResultFile, EveryColumnComesBack) {
    const Results results = filled_example();
    write(file_, results);
    EXPECT_EQ(difference(results, read(file_)), "");
    EXPECT_EQ(files_in_folder(), 1u);
}

TEST_F(ResultFile, EveryMemberIsAColumn) {
    // A member without a column would be lost silently: in the order of their places the columns,
    // with the padding of the compiler, must fill the struct.
    for (const Table& table : tables()) {
        std::vector<Column> columns = table.columns;
        std::ranges::sort(columns, {}, &Column::at);
        std::size_t end = 0, widest = 1;
        const auto pad = [&](std::size_t to) { end = (end + to - 1) / to * to; };
        for (const Column& column : columns) {
            const std::size_t alignment = std::min(column.size, alignof(std::string));
            pad(alignment);
            EXPECT_EQ(column.at, end) << table.name << "." << column.name;
            end += column.size;
            widest = std::max(widest, alignment);
        }
        pad(widest);
        EXPECT_EQ(end, table.row_size) << table.name;
    }
}

TEST_F(ResultFile, MissingAndExtremeValuesComeBack) {
    Results results;
    results.scenes.resize(1);
    results.variants.resize(1);
    results.cells.resize(1);
    results.shards.resize(1);
    results.samples.resize(1);
    results.samples[0].off_median = -0.0;
    results.checks.resize(1);
    results.checks[0].witness = std::string(1024, 'w'); // as wide as the column
    results.env.resize(1);
    write(file_, results);
    const Results back = read(file_);
    EXPECT_EQ(difference(results, back), "");
    EXPECT_TRUE(std::isnan(back.samples.at(0).cpu_ns));
    EXPECT_EQ(back.env.at(0).l3_bytes, no_count);
}

TEST_F(ResultFile, EmptyTablesStand) {
    write(file_, Results{});
    EXPECT_EQ(difference(Results{}, read(file_)), "");
    change([](hid_t file) {
        for (const Table& table : tables())
            EXPECT_GT(H5Lexists(file, std::string(table.name).c_str(), H5P_DEFAULT), 0);
    });
}

TEST_F(ResultFile, MoreRowsThanAChunk) {
    Results results = filled_example(1);
    results.samples.assign(10'000, {});
    for (std::uint32_t i = 0; i < results.samples.size(); ++i) {
        results.samples[i].position = i;
        results.samples[i].wall_ns = (i + 1) * 1.25;
    }
    write(file_, results);
    EXPECT_EQ(difference(results, read(file_)), "");
}

TEST_F(ResultFile, TooLongStringIsAnError) {
    Results results = filled_example(0);
    results.variants.resize(1);
    results.variants[0].name = std::string(161, 'x');
    EXPECT_SAYS(complaint(file_, results), "variants.name");
    results.variants[0].name = std::string("a\0b", 3);
    EXPECT_SAYS(complaint(file_, results), "zero byte");
    results.variants.clear();
    results.texts["a/b"] = "";
    EXPECT_SAYS(complaint(file_, results), "a/b");
    EXPECT_FALSE(fs::exists(file_));
}

TEST_F(ResultFile, FailedWritesLeaveTheOldFile) {
    const Results old = filled_example(1);
    write(file_, old);
    EXPECT_SAYS(complaint(folder_ / "none" / "a.h5", old), "does not exist");
    EXPECT_SAYS(complaint(file_ / "a.h5", old), "directory");
    EXPECT_SAYS(complaint(folder_, old), "not a regular file");
    EXPECT_SAYS(complaint("/dev/full", old), "not a regular file");
    EXPECT_NE(complaint("/proc/a.h5", old), ""); // nobody may make files there
    // The temporary name leads to the device that is always full.
    fs::create_symlink("/dev/full", file_.string() + fmt::format(".tmp-{}", ::getpid()));
    EXPECT_SAYS(complaint(file_, filled_example(2)), "No space left on device");
    EXPECT_EQ(difference(old, read(file_)), "");
    EXPECT_EQ(files_in_folder(), 1u);
}

TEST_F(ResultFile, ALinkStaysALink) {
    const Results results = filled_example(1);
    write(file_, Results{});
    fs::create_symlink(file_, folder_ / "link.h5");
    write(folder_ / "link.h5", results);
    EXPECT_TRUE(fs::is_symlink(folder_ / "link.h5"));
    EXPECT_EQ(difference(results, read(file_)), "");
}

TEST_F(ResultFile, WhatIsNotAResultFile) {
    EXPECT_SAYS(complaint(folder_ / "none.h5"), "no such file");
    EXPECT_SAYS(complaint(folder_), "not a regular file");
    put_bytes(file_, "");
    EXPECT_SAYS(complaint(file_), "empty");
    std::string noise(5000, ' ');
    for (std::size_t i = 0; i < noise.size(); ++i)
        noise[i] = static_cast<char>(i * i * 31 >> 3);
    put_bytes(file_, noise);
    EXPECT_SAYS(complaint(file_), "not an HDF5 file");
    put_bytes(file_, "\x89HDF\r\n\x1a\n" + noise);
    EXPECT_SAYS(complaint(file_), "not a readable HDF5 file");
    fs::remove(file_);
    Handle(H5Fcreate(file_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose, "new");
    EXPECT_SAYS(complaint(file_), "not a Boxwood result file");
}

TEST_F(ResultFile, OtherVersions) {
    write(file_, filled_example(1));
    set_attribute("schema_minor", 9);
    EXPECT_EQ(complaint(file_), "");
    set_attribute("complete", 0);
    EXPECT_SAYS(complaint(file_), "incomplete");
    set_attribute("schema_major", 1);
    EXPECT_SAYS(complaint(file_),
                "it is of schema 1, and this program reads schema 2; measure again");
}

TEST_F(ResultFile, UnknownColumnsAreSkippedAndMissingOnesKeepDefaults) {
    write(file_, filled_example(14));
    struct Other {
        std::int64_t unknown;
        std::int16_t cell_id;
        float wall_ns;
    };
    const std::vector<Other> rows{{-7, 12, 0.5f}, {-8, 13, 1.5f}};
    change([&](hid_t file) {
        const Handle type(H5Tcreate(H5T_COMPOUND, sizeof(Other)), H5Tclose, "type");
        H5Tinsert(type, "unknown", offsetof(Other, unknown), H5T_NATIVE_INT64);
        H5Tinsert(type, "cell_id", offsetof(Other, cell_id), H5T_NATIVE_INT16);
        H5Tinsert(type, "wall_ns", offsetof(Other, wall_ns), H5T_NATIVE_FLOAT);
        const hsize_t n = rows.size();
        const Handle space(H5Screate_simple(1, &n, nullptr), H5Sclose, "space");
        for (const char* name : {"samples", "frames", "unknown_table"}) {
            if (H5Lexists(file, name, H5P_DEFAULT) > 0)
                checked(H5Ldelete(file, name, H5P_DEFAULT), name);
            const Handle dataset(
                H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                H5Dclose, name);
            checked(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()), name);
        }
        for (const char* name : {"medians", "drift"}) // as in a file of an older minor version
            checked(H5Ldelete(file, name, H5P_DEFAULT), name);
    });
    EXPECT_SAYS(complaint(file_),
                "column samples.shard_id is missing; use another copy, or measure again");
    const Results back = read(file_, Required::measured);
    ASSERT_EQ(back.samples.size(), 2u);
    EXPECT_EQ(back.samples[1].cell_id, 13u);
    EXPECT_EQ(back.samples[1].wall_ns, 1.5);
    EXPECT_TRUE(std::isnan(back.samples[1].cpu_ns));
    EXPECT_EQ(back.samples[1].phase, Phase::none);
    ASSERT_EQ(back.frames.size(), 2u);
    EXPECT_EQ(back.frames[1].cell_id, 13u);
    EXPECT_EQ(back.frames[1].box_tests, no_count);
    EXPECT_TRUE(std::isnan(back.frames[1].sah));
    EXPECT_TRUE(back.medians.empty());
    EXPECT_TRUE(back.drift.empty());
    EXPECT_EQ(back.health.size(), 14u);
}

TEST_F(ResultFile, AnOlderMinorVersionMayLackWhatCameLater) {
    Results results = filled_example(2);
    write(file_, results);
    change([&](hid_t file) {
        const Handle older(H5Tcreate(H5T_COMPOUND, sizeof(Shard)), H5Tclose, "older");
        H5Tinsert(older, "shard_id", offsetof(Shard, shard_id), H5T_NATIVE_UINT32);
        H5Tinsert(older, "round", offsetof(Shard, round), H5T_NATIVE_UINT32);
        H5Tinsert(older, "env_id", offsetof(Shard, env_id), H5T_NATIVE_UINT32);
        H5Tinsert(older, "pid", offsetof(Shard, pid), H5T_NATIVE_UINT32);
        H5Tinsert(older, "order_seed", offsetof(Shard, order_seed), H5T_NATIVE_UINT64);
        H5Tinsert(older, "t0_utc_ns", offsetof(Shard, t0_utc_ns), H5T_NATIVE_UINT64);
        H5Tinsert(older, "load1", offsetof(Shard, load1), H5T_NATIVE_DOUBLE);
        H5Tinsert(older, "steal_ticks", offsetof(Shard, steal_ticks), H5T_NATIVE_UINT64);
        checked(H5Ldelete(file, "shards", H5P_DEFAULT), "shards");
        const hsize_t n = 2;
        const Handle space(H5Screate_simple(1, &n, nullptr), H5Sclose, "space");
        const Handle dataset(
            H5Dcreate2(file, "shards", older, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
            H5Dclose, "shards");
        checked(H5Dwrite(dataset, older, H5S_ALL, H5S_ALL, H5P_DEFAULT, results.shards.data()),
                "shards");
    });
    EXPECT_SAYS(complaint(file_), "column shards.padding_bytes is missing; ");
    set_attribute("schema_minor", 0);
    change([](hid_t file) { checked(H5Ldelete(file, "device_gains", H5P_DEFAULT), "delete"); });
    results.device_gains.clear();
    for (Shard& shard : results.shards) {
        shard.padding_bytes = no_count;
        shard.other_cores = missing;
        shard.input = 0;
        shard.gpu_copy_gbs = shard.gpu_upload_gbs = shard.gpu_download_gbs =
            shard.gpu_upload_pageable_gbs = shard.gpu_download_pageable_gbs = shard.gpu_launch_ns =
                missing;
    }
    EXPECT_EQ(difference(results, read(file_)), "");
}

TEST_F(ResultFile, AMissingTableIsAnErrorThatSaysWhatToDo) {
    for (const Table& table : tables()) {
        write(file_, filled_example(1));
        change([&](hid_t file) {
            checked(H5Ldelete(file, std::string(table.name).c_str(), H5P_DEFAULT), table.name);
        });
        EXPECT_SAYS(complaint(file_), fmt::format("table {} is missing; ", table.name));
        EXPECT_SAYS(complaint(file_),
                    table.is_derived
                        ? fmt::format("`boxwood merge {} --out NEW.h5` derives", file_.string())
                        : "use another copy, or measure again");
        if (table.is_derived)
            EXPECT_NO_THROW(read(file_, Required::measured)) << table.name;
        else
            EXPECT_THROW(read(file_, Required::measured), std::runtime_error) << table.name;
    }
}

TEST_F(ResultFile, AnIdThatNamesNoRowIsAnError) {
    for (const Table& table : tables())
        for (const Column& column : table.columns)
            for (const Reference& reference : references) {
                if (reference.column != column.name || reference.table == table.name)
                    continue;
                Results results = filled_example();
                auto& id = column.value<std::uint32_t>(table.rows(results)[1]);
                id = 77;
                write(file_, results);
                EXPECT_SAYS(complaint(file_),
                            fmt::format("column {}.{} holds 77, which no row of {} has; use",
                                        table.name, column.name, reference.table));
                id = no_id;
                write(file_, results);
                EXPECT_EQ(complaint(file_).empty(), table.is_derived) << table.name;
            }
    Results results = filled_example();
    results.cells[2].cell_id = 1;
    write(file_, results);
    EXPECT_SAYS(complaint(file_), "column cells.cell_id holds 1, which stands there twice");
}

TEST_F(ResultFile, ATimeThatIsNoneIsAnErrorThatNamesItsRow) {
    for (const double ns : {0.0, -0.0, -5.0, HUGE_VAL}) {
        Results results = filled_example();
        results.samples[1].wall_ns = ns;
        write(file_, results);
        EXPECT_SAYS(complaint(file_), fmt::format("column samples.wall_ns holds {:g} in row 1, "
                                                  "which is no time; use another copy",
                                                  ns));
    }
    Results results = filled_example();
    results.samples[1].wall_ns = missing;
    write(file_, results);
    EXPECT_EQ(complaint(file_), "");
}

TEST_F(ResultFile, AWordThatIsNoneIsAnErrorThatNamesIt) {
    write(file_, filled_example(1));
    change([&](hid_t file) {
        const Handle dataset(H5Dopen2(file, "compare", H5P_DEFAULT), H5Dclose, "compare");
        const Handle type(H5Tcreate(H5T_COMPOUND, word_width), H5Tclose, "type");
        H5Tinsert(type, "verdict", 0, string_type(word_width));
        std::string word = "quicker";
        word.resize(word_width);
        checked(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, word.data()), "compare");
    });
    EXPECT_SAYS(complaint(file_), "column compare.verdict holds the unknown word \"quicker\"; use");
}

TEST_F(ResultFile, WhoChangesItBreaksTheSeal) {
    Results example = filled_example();
    for (Env& env : example.env)
        env.cpu = env.isa_max = "one";
    write(file_, example);
    EXPECT_TRUE(read(file_).is_sealed);
    set_attribute("schema_minor", 0); // nothing is different but that it was written to
    EXPECT_FALSE(read(file_).is_sealed);
    const Results changed = read(file_);
    write(file_, merge(std::span(&changed, 1)));
    EXPECT_FALSE(read(file_).is_sealed); // for good
}

TEST_F(ResultFile, TruncatedAnywhereIsAnError) {
    write(file_, filled_example());
    const std::string all = bytes_of(file_);
    const std::size_t unsealed =
        all.size() - 16; // without the seal, or a part of it, all of the data is there
    for (std::size_t n = 0; n < all.size(); n += n < 100 ? 1 : 97) {
        put_bytes(file_, std::string_view(all).substr(0, n));
        EXPECT_EQ(complaint(file_) == "", n >= unsealed) << n;
    }
    put_bytes(file_, std::string_view(all).substr(0, unsealed));
    EXPECT_EQ(complaint(file_), "");
}

TEST_F(ResultFile, AFlippedBitIsAnErrorOrHarmless) {
    const Results results = filled_example();
    write(file_, results);
    const std::string all = bytes_of(file_);
    std::size_t refused = 0, tried = 0;
    for (std::size_t i = 0; i < all.size(); i += 61, ++tried) {
        std::string bad = all;
        bad[i] = static_cast<char>(bad[i] ^ 1 << i % 8);
        put_bytes(file_, bad);
        try {
            EXPECT_EQ(difference(results, read(file_)), "") << i;
        } catch (const std::runtime_error&) {
            ++refused;
        }
    }
    EXPECT_GE(refused + 1, tried); // only a flip in the mark of the seal may go unseen
}

TEST_F(ResultFile, PythonReadsIt) {
    if (std::system("/usr/bin/python3 -c 'import h5py' 2>/dev/null") != 0)
        GTEST_SKIP() << "python3-h5py is not installed: scripts/setup does that";
    write(file_, filled_example());
    const std::string script =
        "import sys, json, h5py\n"
        "with h5py.File(sys.argv[1], 'r') as f:\n"
        "    assert f.attrs['format'] == 'boxwood-results' and f.attrs['complete'] == 1\n"
        "    s = f['samples']\n"
        "    assert s.shape == (3,) and s.maxshape == (None,)\n"
        "    assert s.shuffle and s.fletcher32 and s.compression == 'gzip'\n"
        "    assert json.loads(s.attrs['units'])['wall_ns'] == 'ns'\n"
        "    assert list(json.loads(s.attrs['columns'])) == list(s.dtype.names)\n"
        "    assert s['phase'].dtype.itemsize == 32\n"
        "    assert f['text/lscpu'].asstr()[()].startswith('Modell')\n"
        "try:\n"
        "    import pandas, tables\n"
        "except ImportError:\n"
        "    sys.exit(0)\n"
        "assert len(pandas.read_hdf(sys.argv[1], 'samples')) == 3\n";
    put_bytes(folder_ / "read.py", script);
    EXPECT_EQ(std::system(fmt::format("/usr/bin/python3 -W ignore '{}' '{}'",
                                      (folder_ / "read.py").string(), file_.string())
                              .c_str()),
              0);
}

TEST(ResultsReadme, NamesEveryTableAndColumn) {
    const std::string readme = bytes_of("results/README.md");
    ASSERT_FALSE(readme.empty()) << "tests run in the root of the repository";
    for (const Table& table : tables()) {
        const auto heading = readme.find(fmt::format("## /{}\n", table.name));
        ASSERT_NE(heading, std::string::npos) << table.name;
        const auto end = readme.find("\n## ", heading);
        const std::string section = readme.substr(heading, end - heading);
        for (const Column& column : table.columns)
            EXPECT_NE(section.find(fmt::format("| `{}` |", column.name)), std::string::npos)
                << table.name << "." << column.name;
    }
}

} // namespace
} // namespace boxwood::results
