#include "files/deferred_signals.h"

#include <array>
#include <csignal>
#include <mutex>

namespace skinglow::detail {
namespace {

constexpr std::array signals = {SIGINT, SIGTERM, SIGHUP};

// Handlers belong to the process. NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables)
std::mutex mutex;
int users = 0;
std::array<struct sigaction, signals.size()> before{};

// A handler may touch nothing else; signals come on any thread, so that blocking them on one does not do.
volatile std::sig_atomic_t waiting = 0;
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

extern "C" void note_signal(int number) {
    waiting = number;
}

}  // namespace

DeferredSignals::DeferredSignals() {
    const std::lock_guard lock(mutex);
    if (users++ > 0) return;
    waiting = 0;
    for (std::size_t i = 0; i < signals.size(); ++i) {
        ::sigaction(signals[i], nullptr, &before[i]);
        if (before[i].sa_handler == SIG_IGN) continue;  // as under nohup
        struct sigaction action {};
        action.sa_handler = note_signal;
        action.sa_flags = SA_RESTART;
        ::sigaction(signals[i], &action, nullptr);
    }
}

DeferredSignals::~DeferredSignals() {
    const std::lock_guard lock(mutex);
    if (--users > 0) return;
    for (std::size_t i = 0; i < signals.size(); ++i) ::sigaction(signals[i], &before[i], nullptr);
    if (waiting != 0) ::raise(waiting);
}

}  // namespace skinglow::detail
