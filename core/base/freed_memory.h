#pragma once

namespace lamella {

/// Keeps memory that is freed for what is asked for next, up to half a gigabyte, instead of giving
/// each large array back to the system and taking it again page by page: an eighth of the time of
/// an adaption. For programs, once at their start; nothing where the C library is not glibc.
void keep_freed_memory();

/// Gives back what was kept: between steps that need much and nothing of each other.
void give_back_freed_memory();

}  // namespace lamella
