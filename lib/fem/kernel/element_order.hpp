#pragma once
/// The order in which elements are worked off: SIMD batches, chunks of batches, colours of chunks.
///
/// A chunk holds elements of one material; chunks of one colour share no node. The cut follows the mesh alone, so
/// results have the same bits whatever the number of threads: colours one after the other, the chunks of a colour in
/// any order or at the same time.
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace muldi::fem {

class ElementOrder {
 public:
  /// Batches that one call of a kernel works off; pointers into the order.
  struct Range {
    int n_batches = 0;
    const int* nodes = nullptr;     ///< [batch][8][lane], the corner by the bits of its index (hexahedron.hpp)
    const int* elements = nullptr;  ///< [batch][lane]; the lanes beyond `active` repeat the last element
    const int* active = nullptr;    ///< [batch] number of lanes that count
    int first_batch = 0;            ///< number of the first batch in the whole order
  };
  struct Chunk {
    int first_batch = 0;
    int n_batches = 0;
    int material = 0;
    int colour = 0;
  };

  /// `elements` (n): node numbers in VTK's corner order; `materials` (n): material of each; `lanes`: of the kernels;
  /// `chunk_elements`: about how many elements a chunk holds. Within a material elements are worked off by their
  /// smallest node, so a numbering of nodes with good locality gives a good order.
  ElementOrder(std::span<const std::array<int, 8>> elements, std::span<const int> materials, int lanes,
               int chunk_elements = 256);

  int lanes() const { return lanes_; }
  int n_elements() const { return n_elements_; }
  int n_batches() const { return static_cast<int>(active_.size()); }
  int n_colours() const { return static_cast<int>(colours_.size()); }
  const std::vector<Chunk>& chunks() const { return chunks_; }
  /// Numbers of the chunks of a colour, ascending.
  const std::vector<int>& colour(int c) const { return colours_[static_cast<std::size_t>(c)]; }
  Range range(const Chunk& chunk) const;

  /// Where the kernels add the blocks of an element: [batch][36][lane], one entry for each pair a <= b of corners by
  /// bits. `find(row node, column node)` gives 2 slot + 1 if the stored block is the transpose of (row, column), else
  /// 2 slot.
  std::vector<std::int32_t> block_slots(const std::function<std::int32_t(int row, int column)>& find) const;

 private:
  void add_chunk(std::span<const int> of, std::span<const std::array<int, 8>> elements, int material);
  void colour_chunks(int n_nodes);

  int lanes_;
  int n_elements_;
  std::vector<int> nodes_;
  std::vector<int> elements_;
  std::vector<int> active_;
  std::vector<Chunk> chunks_;
  std::vector<std::vector<int>> colours_;
};

/// Calls work(chunk) for all chunks, colour by colour, through `run(n, call)`, which calls call(0) .. call(n - 1) in
/// any order, at the same time if it likes, and returns when all are done.
template <class Run, class Work>
void for_each_chunk(const ElementOrder& order, const Run& run, const Work& work) {
  for (int c = 0; c < order.n_colours(); ++c) {
    const std::vector<int>& of = order.colour(c);
    run(static_cast<int>(of.size()), [&](int i) {
      const auto at = static_cast<std::size_t>(of[static_cast<std::size_t>(i)]);
      work(order.chunks()[at], static_cast<int>(at));
    });
  }
}

/// `run` of for_each_chunk in the calling thread.
inline constexpr auto one_after_the_other = [](int n, const auto& call) {
  for (int i = 0; i < n; ++i) call(i);
};

}  // namespace muldi::fem
