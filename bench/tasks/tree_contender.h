#pragma once

#include "bench/tasks/contender.h"
#include "trees/builder.h"
#include "trees/layout.h"

#include <memory>
#include <utility>

namespace boxwood::bench {

/// What our contenders share that ask one tree: boxes to tree to layout, and what they are asked.
class TreeContender : public Contender {
  public:
    TreeContender(const Job& job, BuildFunction build, const LayoutEntry& layout)
        : scene_(*job.scene), ask_(job.task), executor_(make_executor(job.executor, job.threads)),
          build_(std::move(build)), layout_entry_(layout) {}

    void build() override {
        layout_.reset();
        layout_ = make_layout(layout_entry_, build_, scene_.boxes, *executor_, tree_);
    }
    std::optional<StructureInfo> structure() const override {
        return StructureInfo{layout_->bytes(), &tree_};
    }

  protected:
    const Scene& scene_;
    Ask ask_;
    std::unique_ptr<Executor> executor_;
    BuildFunction build_;
    const LayoutEntry& layout_entry_;
    Tree tree_;
    std::unique_ptr<AnyLayout> layout_;
};

} // namespace boxwood::bench
