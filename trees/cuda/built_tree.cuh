#pragma once

#include "trees/cuda/codes.cuh"
#include "trees/cuda/hploc.cuh"
#include "trees/cuda/packed.cuh"
#include "trees/cuda/wide8.cuh"

namespace boxwood::cuda {

/// What a tree on the device is.
enum class Form : std::uint8_t {
    packed,      ///< sixteen wide, without pointers: for pairs and regions
    radix,       ///< binary, by the codes
    hploc,       ///< binary, by area
    radix_wide8, ///< eight wide, of either of these: for rays
    hploc_wide8
};

/// A tree in the device's memory, and all that its build needs. The boxes stay the caller's. Once
/// it was built, no memory is allocated and none moves while n is at most `capacity()`, so that a
/// graph may capture enqueue() and refit(), and views stay what they are while n is the same.
class BuiltTree {
  public:
    explicit BuiltTree(Form form, Curve curve = Curve::hilbert) : form_(form), curve_(curve) {}

    /// Of n boxes in the device's memory; waits for it. Throws InvalidBox for the first bad one, as
    /// the CPU does, and std::length_error for more than max_items.
    void build(const Box* boxes, std::size_t n, Stream stream);

    /// The same without waiting. Of bad boxes comes a tree with wrong answers, which nothing else
    /// suffers from; check() finds them.
    void enqueue(const Box* boxes, std::size_t n, Stream stream);
    /// Waits, and throws as build(). False if so many boxes have the same codes that build() would
    /// now take finer ones: the tree is right, but slow.
    bool check(const Box* boxes, Stream stream);

    /// New boxes for the items where they are: of all items, or of those named, which may be so
    /// more than once (packed alone; the others' boxes are as they were).
    void refit(const Box* boxes, Stream stream);
    void refit(const Box* boxes, const std::uint32_t* moved, std::size_t n_moved, Stream stream);

    Form form() const { return form_; }
    std::size_t size() const { return n_; }
    std::size_t capacity() const;
    /// That a tree of n items takes on the device, to the bytes of the sort's own, which are few.
    static std::size_t bytes(Form form, std::size_t n);

    /// Of the form that it has. Bounds of all items are in the device's memory, too.
    const PackedView& packed() const;
    const RadixTreeView& radix() const;
    const BinaryView& hploc() const;
    const Wide8View& wide8() const;
    const Box* bounds() const;
};

} // namespace boxwood::cuda
