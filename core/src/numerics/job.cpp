#include "numerics/job.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace skinglow::detail {
namespace {

constexpr std::chrono::milliseconds between_calls(10);

thread_local Job* job_of_thread = nullptr;

}  // namespace

double Job::fraction() {
    const double expected = expected_;
    if (expected > 0) largest_ = std::clamp(finished_ / expected, largest_, 1.0);
    return largest_;
}

Job* Job::current() {
    return job_of_thread;
}

Job::Scope::Scope(Job* job) : before_(job_of_thread) {
    job_of_thread = job;
}

Job::Scope::~Scope() {
    job_of_thread = before_;
}

void stop_if_asked() {
    if (job_of_thread != nullptr && job_of_thread->is_stopped()) throw JobStopped();
}

void expect_work(double work) {
    if (job_of_thread != nullptr) job_of_thread->expect(work);
}

void finish_work(double work) {
    if (job_of_thread != nullptr) job_of_thread->finish(work);
}

bool run_job(const std::function<bool(double)>& progress, const std::function<void()>& work) {
    if (!progress) {
        work();
        return true;
    }
    if (!progress(0.0)) return false;
    Job job;
    std::mutex access;
    std::condition_variable changed;
    bool is_over = false;
    bool goes_on = true;
    std::exception_ptr failure;
    std::exception_ptr of_progress;
    {
        const std::jthread worker([&] {
            const Job::Scope scope(&job);
            try {
                work();
            } catch (...) {
                failure = std::current_exception();
            }
            const std::scoped_lock lock(access);
            is_over = true;
            changed.notify_one();
        });
        std::unique_lock lock(access);
        while (!changed.wait_for(lock, between_calls, [&] { return is_over; })) {
            if (job.is_stopped()) continue;
            lock.unlock();
            try {
                goes_on = progress(job.fraction());
            } catch (...) {
                of_progress = std::current_exception();
            }
            if (!goes_on || of_progress) job.stop();
            lock.lock();
        }
    }
    if (of_progress) std::rethrow_exception(of_progress);
    if (!goes_on) return false;
    if (failure) std::rethrow_exception(failure);
    return progress(1.0);
}

}  // namespace skinglow::detail
