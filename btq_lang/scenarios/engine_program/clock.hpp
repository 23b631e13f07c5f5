// The time of the program: it passes only when the program lets it pass, also for the timers of the engine.
#pragma once

#include <cstdint>

namespace virtual_clock
{
// In milliseconds since the start.
int64_t now();

// Waits until the thread of each timer waits; false if that takes long, because this clock is not theirs.
bool begin();

// Lets the threads look whether they have a timer to wait for.
void poke();

// Lets time pass until the first timer goes off, but not beyond a time.  All timers that are due go off one after the
// other, in the order in which their nodes were made.
void advance(int64_t until);

// Set when the main thread would wait; it goes on at once.
extern bool has_slept;
}  // namespace virtual_clock
