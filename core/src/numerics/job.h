#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Long work that can be stopped, and how much of it is done. It belongs to the threads it runs on, those that
/// for_each_block starts included, so that code deep inside need not hand it on.
class Job {
  public:
    /// Finished over expected work, 0 to 1; never falls, though more may be expected on the way.
    double fraction();
    void stop() { is_stopped_ = true; }
    bool is_stopped() const { return is_stopped_; }
    void expect(double work) { expected_ += work; }
    void finish(double work) { finished_ += work; }

    /// The job that this thread works for; null: none.
    static Job* current();

    /// Makes this thread work for a job until the end of the scope.
    class Scope {
      public:
        explicit Scope(Job* job);
        ~Scope();
        Scope(const Scope&) = delete;
        Scope& operator=(const Scope&) = delete;

      private:
        Job* before_;
    };

  private:
    std::atomic<bool> is_stopped_ = false;
    std::atomic<double> expected_ = 0;
    std::atomic<double> finished_ = 0;
    double largest_ = 0;
};

/// Thrown out of a job that was stopped.
class JobStopped : public std::exception {
  public:
    const char* what() const noexcept override { return "the work was stopped"; }
};

/// Where work may end early: throws JobStopped if this thread's job was stopped. for_each_block calls it for each
/// block.
void stop_if_asked();
/// The same in a loop of many small steps: at some of them.
inline void stop_if_asked(std::size_t step) {
    if (step % 256 == 0) stop_if_asked();
}
/// Of this thread's job, in any unit; nothing without one.
void expect_work(double work);
void finish_work(double work);

/// Runs `work` as a job, on a thread of its own, while this thread tells `progress` the fraction done every
/// hundredth of a second: 0 first, ascending, 1 last. So the caller can stop it at any time, whatever thread is
/// busy, and a host's functions are called on the thread that asked.
/// @param progress  returns whether to go on; empty: the work runs on this thread, as a part of its job if it has one
/// @return false where `progress` returned false. Throws what `work` or `progress` throws.
bool run_job(const std::function<bool(double)>& progress, const std::function<void()>& work);

}  // namespace skinglow::detail
