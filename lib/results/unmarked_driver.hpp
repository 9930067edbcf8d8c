#pragma once
/// How the HDF5 library reaches the disk when we write: a virtual file driver that leaves a readable file at every
/// moment, also to a process that is killed.
///
/// The library marks a file that is open for writing in its superblock, and the mark survives a killed process. This
/// driver never lets the mark reach the disk; writers are kept apart by a lock instead (live_file.hpp).
///
/// Rows (SWMR) are written at once, in the order in which the library makes them safe to read. The superblock on the
/// disk claims some room beyond the end, ahead of every byte, so that all that is written lies inside the file.
/// All other changes are staged: pages in memory, which reach the disk when the file is closed, the first one, that of
/// the superblock and of the root group, at the end and in one piece. New pages go before it, so it never refers to
/// what is not there. If the disk fills up on the way, the old file is still what the first page describes.
/// API: HDF5 1.10, H5FDpublic.h.
#include <cstdint>

namespace muldi::results::hdf5 {

/// How a file is written through the driver.
struct Writing {
  enum class Order : int {
    at_once,        ///< rows
    highest_first,  ///< staged; what is new is written before what refers to it
    lowest_first,   ///< staged; headers of data sets are written before what they no longer refer to goes
  };
  Order order = Order::at_once;
};

/// Lets a file that is opened with these access properties be written through the driver; false if the library fails.
bool set_driver(std::int64_t access_properties, Writing writing);

/// Lets a file be read with a look at its heaps (global_heap.hpp). A driver of its own: in one process a file that is
/// read and written is open twice.
bool set_reading_driver(std::int64_t access_properties);

/// From here on nothing more reaches the disk from the file whose handle (H5Fget_vfd_handle) this is.
void abandon(void* handle);

}  // namespace muldi::results::hdf5
