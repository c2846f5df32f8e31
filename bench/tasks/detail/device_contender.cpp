#include "bench/tasks/detail/device_contender.h"

namespace boxwood::bench {

void DeviceContender::build() {
    if (!is_resident_ || !is_uploaded_)
        upload_bytes_ = upload();
    if (is_resident_ && !is_uploaded_)
        upload_queries();
    is_uploaded_ = true;
    const std::uint64_t before = launches_so_far();
    build_there();
    build_launches_ = launches_so_far() - before;
    wait_for(place());
}

void DeviceContender::query(Answers& answers) {
    if (!is_resident_)
        query_upload_bytes_ = upload_queries();
    const std::uint64_t before = launches_so_far();
    query_there();
    query_launches_ = launches_so_far() - before;
    if (is_resident_)
        wait_for(place());
    else
        download_bytes_ = download(answers);
}

std::vector<NamedCount> DeviceContender::more_counts() const {
    std::vector<NamedCount> counts{{"build_launches", build_launches_},
                                   {"query_launches", query_launches_}};
    if (!is_resident_)
        counts.insert(counts.end(), {{"upload_bytes", upload_bytes_},
                                     {"query_upload_bytes", query_upload_bytes_},
                                     {"download_bytes", download_bytes_}});
    return counts;
}

void DeviceContender::fetch(Answers& answers) {
    if (is_resident_)
        download(answers);
    convert(answers);
}

std::vector<DeviceTime> DeviceContender::device_times(Answers& answers) {
    if (is_resident_)
        return {};
    using results::Phase;
    DeviceTimer timer(place());
    std::vector<DeviceTime> times;
    const auto time = [&](Phase phase, const auto& work) {
        timer.start();
        work();
        times.push_back({phase, timer.stop_ns()});
    };
    time(Phase::upload, [&] {
        upload();
        upload_queries();
    });
    time(Phase::device_build, [&] { build_there(); });
    time(Phase::device_query, [&] { query_there(); });
    time(Phase::download, [&] { download(answers); });
    return times;
}

std::optional<DeviceBuilder> device_builder(const Choice& choice,
                                            std::string_view layout_of_trees) {
    if (!choice.settings.empty())
        return std::nullopt;
    if (choice.builder == "hilbert" && choice.layout == "packed")
        return DeviceBuilder::hilbert;
    if (choice.layout != layout_of_trees)
        return std::nullopt;
    if (choice.builder == "lbvh")
        return DeviceBuilder::lbvh;
    if (choice.builder == "ploc")
        return DeviceBuilder::hploc;
    return std::nullopt;
}

std::uint64_t DeviceBoxes::upload() {
    if (boxes_.size() != scene_.boxes.size())
        boxes_ = DeviceArray<Box>(scene_.boxes.size(), options_.place);
    boxes_.write(scene_.boxes);
    return boxes_.size_bytes();
}

void DeviceBoxes::build_there() {
    const DeviceSpan<const Box> boxes = std::as_const(boxes_).span();
    if (bvh_)
        bvh_->rebuild(boxes);
    else
        bvh_.emplace(boxes, options_);
}

/// Bytes that a build by sixteens reads and writes: bounds 24 a box, codes 32, their sort 72,
/// leaves 80, the levels above 5.
std::vector<NamedCount> DeviceBoxes::more_counts() const {
    std::vector<NamedCount> counts = DeviceContender::more_counts();
    if (options_.builder == DeviceBuilder::hilbert)
        counts.push_back({"build_bytes", 213 * scene_.boxes.size()});
    return counts;
}

std::uint64_t ItemsOfQueries::download(Answers&) {
    found_.offsets.read(on_host_.offsets);
    found_.of.read(on_host_.of);
    return found_.offsets.size_bytes() + found_.of.size_bytes();
}
void ItemsOfQueries::convert(Answers& answers) {
    std::vector<Pair>& pairs = list_of<Pair>(answers);
    pairs.clear();
    for (std::uint32_t query = 0; query + 1 < on_host_.offsets.size(); ++query)
        for (const std::uint32_t item : on_host_[query])
            pairs.push_back({query, item});
}

} // namespace boxwood::bench
