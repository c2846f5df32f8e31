#include "scenes/moving/recording.h"

#include "scenes/text/rows.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace boxwood {
namespace {

std::size_t whole(double number, std::string_view what, const std::string& place) {
    if (!(number >= 0 && number < 0x1p30 && number == std::floor(number)))
        throw std::runtime_error(
            fmt::format("{}: {} counts from 0 in whole numbers; {} is none", place, what, number));
    return static_cast<std::size_t>(number);
}

} // namespace

Recording read_recording(const std::filesystem::path& file) {
    Recording frames(1);
    std::vector<bool> has_begun; // by body, in frame 0
    read_rows(file, {"frame,body,min_x,min_y,min_z,max_x,max_y,max_z", 8, 8},
              [&](std::span<const double> row, const std::string& place) {
                  const std::size_t frame = whole(row[0], "frame", place);
                  const std::size_t body = whole(row[1], "body", place);
                  const Aabb<float> box = box_of(row.subspan<2, 6>(), place);
                  if (frame == 0 && frames.size() == 1) {
                      if (body >= has_begun.size()) {
                          has_begun.resize(body + 1);
                          frames[0].resize(body + 1);
                      }
                      has_begun[body] = true;
                      frames[0][body] = box;
                      return;
                  }
                  for (std::size_t i = 0; i < has_begun.size() && frames.size() == 1; ++i)
                      if (!has_begun[i])
                          throw std::runtime_error(
                              fmt::format("{}: frame 0 has no box of body {}", place, i));
                  if (frame + 1 < frames.size())
                      throw std::runtime_error(
                          fmt::format("{}: frame {} comes after frame {}; sort the rows by frame",
                                      place, frame, frames.size() - 1));
                  if (body >= frames[0].size())
                      throw std::runtime_error(
                          fmt::format("{}: frame 0 has no body {}", place, body));
                  while (frames.size() <= frame)
                      frames.push_back(frames.back());
                  frames[frame][body] = box;
              });
    if (frames.size() < 2)
        throw std::runtime_error(file.string() + ": it holds one frame; a motion has two at least");
    return frames;
}

} // namespace boxwood
