#include "bench/commands/doctor.h"

#include "bench/commands/devices.h"
#include "bench/commands/list.h"
#include "bench/commands/queries/query.h"
#include "bench/io/bad_input.h"
#include "scenes/meshes/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>

namespace boxwood::bench {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

Machine quiet() {
    Machine m;
    m.cores = 8;
    m.governor = "performance";
    m.boost = false;
    m.smt = false;
    m.thp = "madvise";
    return m;
}

Finding finding(const Machine& machine, std::string_view name) {
    for (const Finding& f : examine(machine))
        if (f.name == name)
            return f;
    ADD_FAILURE() << "nothing about " << name;
    return {};
}

TEST(Doctor, AQuietMachineIsFine) {
    for (const Finding& f : examine(quiet())) {
        EXPECT_EQ(f.level, Level::ok) << f.name;
        EXPECT_EQ(f.advice, "") << f.name;
    }
}

TEST(Doctor, WarnsOfWhatSpoilsTimings) {
    Machine m = quiet();
    m.governor = "powersave";
    m.load1 = 3;
    m.steal = 0.1;
    m.quota = 1.5;
    for (const char* name : {"clock governor", "load", "stolen time", "cores"}) {
        EXPECT_EQ(finding(m, name).level, Level::warn) << name;
        EXPECT_NE(finding(m, name).advice, "") << name;
    }
}

TEST(Doctor, NotesWhatIsWorthKnowing) {
    Machine m = quiet();
    m.boost = true;
    m.smt = true;
    m.virt = "KVM";
    m.thp = "always";
    m.cores = 2;
    m.load1 = 0.5;
    m.steal = 0.01;
    for (const Finding& f : examine(m))
        EXPECT_EQ(f.level, f.name == "clock governor" ? Level::ok : Level::note) << f.name;
}

TEST(Doctor, AQuotaAboveTheCoresLimitsNothing) {
    Machine m = quiet();
    m.quota = 8;
    EXPECT_EQ(finding(m, "cores").level, Level::ok);
}

TEST(Doctor, AFolderThatIsNotThereIsAWarning) {
    EXPECT_EQ(examine_disk("/no/such/folder").at(0).level, Level::warn);
    EXPECT_EQ(examine_disk(".").at(0).name, "free disk");
}

TEST(Doctor, TheReportHoldsItsParts) {
    const std::string text = doctor(false);
    const char* const gpu = devices().empty() ? "GPU: none" : "cuda:0 ECC";
    for (const char* part : {"What may spoil timings", "Instruction sets", "Peers", "brute_force",
                             "packages:", "GB/s", "free disk", gpu})
        EXPECT_THAT(text, HasSubstr(part));
}

Device made_up(int index) {
    Device device;
    device.index = index;
    device.name = "NVIDIA H100 PCIe";
    device.bus_id = "0000:3B:00.0";
    device.multiprocessors = 114;
    device.memory_bytes = std::uint64_t{80} << 30;
    device.capability_major = 9;
    device.driver = 13020;
    device.runtime = 13000;
    device.ecc = true;
    return device;
}

const std::vector<Device> two{made_up(0), made_up(1)};

TEST(Devices, AreCalledByNameOrNotAtAll) {
    EXPECT_EQ(chosen_device("cuda", two, ""), 0);
    EXPECT_EQ(chosen_device("cuda:1", two, ""), 1);
    EXPECT_THAT([] { chosen_device("cuda:7", two, ""); },
                ThrowsMessage<BadInput>(HasSubstr("unknown device 'cuda:7'; did you mean 'cuda:")));
    EXPECT_THAT([] { chosen_device("cuda:0", {}, "no driver: install it"); },
                ThrowsMessage<BadInput>("no device 'cuda:0': no driver: install it"));
}

TEST(Devices, SummaryHasWhatTellsThemApart) {
    EXPECT_EQ(device_summary(two[0]),
              "NVIDIA H100 PCIe: 114 multiprocessors, 80.0 GiB, sm_90, driver 13.2, runtime 13.0");
}

TEST(Devices, DoctorSaysWhyThereIsNone) {
    const auto findings = examine_devices({}, "no driver", {});
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_EQ(findings[0].level, Level::note);
    EXPECT_EQ(findings[0].advice, "no driver");
}

TEST(Devices, DoctorReadsClocksAndOtherUsers) {
    const auto quiet =
        examine_devices({two.data(), 1}, "", {"00000000:3B:00.0, 1755, 1755, Enabled\n", ""});
    for (const Finding& f : quiet)
        EXPECT_EQ(f.level, Level::ok) << f.name;
    EXPECT_EQ(quiet.at(1).value, "1755 of 1755 MHz");

    Device device = two[0];
    device.ecc = false;
    const auto busy =
        examine_devices({&device, 1}, "",
                        {"00000000:5E:00.0, 9, 9, Enabled\n00000000:3B:00.0, 345, 1755, Disabled\n",
                         "00000000:3B:00.0, 4711, 512\n00000000:5E:00.0, 1, 2\n"});
    EXPECT_EQ(busy.at(1).value, "345 of 1755 MHz");
    EXPECT_EQ(busy.at(1).level, Level::note);
    EXPECT_EQ(busy.at(2).level, Level::note);
    EXPECT_EQ(busy.at(3).level, Level::warn);
    EXPECT_EQ(busy.at(3).value, "process 4711");
}

/// On a machine with a device these say what it is.
TEST(Devices, ListAndQuerySayWhyThereIsNone) {
    const std::string text = list_text("devices", false);
    if (!devices().empty())
        GTEST_SKIP() << "there is a device here, and this is about having none:\n" << text;
    EXPECT_THAT(why_no_device(), Not(::testing::IsEmpty()));
    EXPECT_THAT(text, HasSubstr("none: "));
    EXPECT_THAT(list_text("", false), HasSubstr("`boxwood list devices` says why"));
    PairsQuery query;
    query.boxes = "/dev/null";
    query.device = "cuda:0";
    EXPECT_THAT([&] { run(query, std::cout); },
                ThrowsMessage<BadInput>(HasSubstr("no device 'cuda:0': " + why_no_device())));
}

TEST(Doctor, LooksAtAMesh) {
    const auto folder = std::filesystem::temp_directory_path();
    const auto file = folder / "boxwood_doctor.obj", good = folder / "boxwood_doctor_good.obj";
    std::ofstream(file) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 2 0 0\nv nan 0 1e39\n"
                           "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\nf 1 2 5\nf 3 2 1\nf 1 2 3 6\n";
    EXPECT_THROW(load_mesh(file), std::runtime_error);
    const TriangleMesh mesh = load_mesh(file, NotFinite::keep);
    const std::string text = doctor_of_mesh(mesh, "a.obj", false);
    EXPECT_THAT(text, HasSubstr("a.obj: 8 triangles"));
    EXPECT_THAT(text, HasSubstr("NaN or inf  1 "));
    EXPECT_THAT(text, HasSubstr("without area       1 (the first: triangle 4)"));
    EXPECT_THAT(text, HasSubstr("It is closed but for"));
    const std::string json = doctor_of_mesh(mesh, "a.obj", true);
    EXPECT_THAT(json, HasSubstr("\"not_finite\":1,"));
    EXPECT_THAT(json, HasSubstr("\"open_edges\":0"));
    EXPECT_THAT(json, HasSubstr("\"is_clean\":false}"));
    std::filesystem::remove(good);
    write_good_triangles(mesh, good.string());
    EXPECT_THAT(doctor_of_mesh(load_mesh(good), "b.obj", false),
                HasSubstr("It is closed: it may be a solid"));
    EXPECT_THROW(write_good_triangles(mesh, good.string()), BadInput);
    TriangleMesh large = load_mesh(good);
    large.vertices[large.triangles[2][0]].x = 0x1p60f;
    EXPECT_THAT(
        doctor_of_mesh(large, "c.obj", true),
        AllOf(HasSubstr("\"too_large\":3,"), HasSubstr("\"is_closed\":true,\"is_clean\":false}")));
    EXPECT_THAT(doctor_of_mesh(large, "c.obj", false),
                AllOf(HasSubstr("beyond 2^60        3 (the first: triangle 0)"),
                      HasSubstr("another unit")));
    std::filesystem::remove(good);
    std::filesystem::remove(file);
}

} // namespace
} // namespace boxwood::bench
