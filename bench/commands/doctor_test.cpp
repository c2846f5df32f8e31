#include "bench/commands/doctor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace boxwood::bench {
namespace {

using ::testing::HasSubstr;

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
    for (const char* part : {"What may spoil timings", "Instruction sets", "Peers", "brute_force",
                             "packages:", "GB/s", "free disk"})
        EXPECT_THAT(text, HasSubstr(part));
}

} // namespace
} // namespace boxwood::bench
