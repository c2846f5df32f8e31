#pragma once

#include "bench/tasks/contender.h"
#include "trees/builder.h"
#include "trees/layout.h"
#include "trees/triangle_boxes.h"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace boxwood::bench {

/// What our contenders share that answer from one tree: boxes, or triangles, to tree to layout.
class TreeContender : public Contender {
  public:
    TreeContender(const Job& job, BuildFunction build, const LayoutEntry& layout)
        : scene_(*job.scene), executor_(make_executor(job.executor, job.threads)),
          build_(std::move(build)), layout_entry_(layout) {}

    void build() override {
        layout_.reset();
        if (is_of_mesh()) {
            const Buffer<Box> boxes = triangle_boxes(scene_.mesh, *executor_);
            layout_ = make_layout(layout_entry_, build_, boxes.span(), *executor_, tree_);
        } else {
            layout_ = make_layout(layout_entry_, build_, scene_.boxes, *executor_, tree_);
        }
    }
    std::optional<StructureInfo> structure() const override {
        return StructureInfo{layout_->bytes(), &tree_};
    }

  protected:
    /// Whether it is given triangles, as peers are, and makes their boxes itself.
    virtual bool is_of_mesh() const { return false; }

    const Scene& scene_;
    std::unique_ptr<Executor> executor_;
    BuildFunction build_;
    const LayoutEntry& layout_entry_;
    Tree tree_;
    std::unique_ptr<AnyLayout> layout_;
};

/// The same settings at the front door.
template <class Options>
Options front_door_options(const Job& job, BuildFunction build, const LayoutEntry& layout) {
    Options options;
    options.builder = std::move(build);
    options.layout = static_cast<LayoutName>(&layout - layouts().data());
    options.executor = make_executor(job.executor, job.threads);
    return options;
}

/// Appends pairs to one vector after another; the sink keeps its memory between queries.
class PairsInto {
  public:
    /// The cleared list's sink.
    AppendPairs& to(Answers& answers) {
        std::vector<Pair>& pairs = list_of<Pair>(answers);
        pairs.clear();
        if (target_ != &pairs) {
            sink_.emplace(pairs);
            target_ = &pairs;
        }
        return *sink_;
    }

  private:
    std::optional<AppendPairs> sink_;
    std::vector<Pair>* target_ = nullptr;
};

} // namespace boxwood::bench
