#pragma once
/// The memory of this machine, and what does not fit into it.
#include <string>

namespace muldi::base {

/// Bytes of physical memory, or of what a process may have of it (`ulimit -v`); infinite where the system does not
/// tell.
double machine_memory();

/// Throws InputError if `bytes` are more than the machine has: "<what> takes 120 GiB, more than the 16 GiB of this
/// machine: <mend>".
void require_memory(double bytes, const std::string& what, const std::string& mend);

}  // namespace muldi::base
