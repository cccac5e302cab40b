#include "numerics/job.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <stdexcept>
#include <thread>
#include <vector>

#include "numerics/parallel_blocks.h"

namespace skinglow {
namespace {

/// Work that does not end unless it is stopped, on some threads that start others.
void endless() {
    const auto inner = [](std::size_t, std::size_t) { std::this_thread::yield(); };
    const auto outer = [&](std::size_t, std::size_t) {
        for_each_block(std::size_t{1} << 40U, 2, inner, {}, 1);
    };
    for_each_block(3, 3, outer, {}, 1);
}

TEST(RunJob, TellsWhatIsDoneOnTheThreadThatAsked) {
    std::vector<double> told;
    const std::thread::id here = std::this_thread::get_id();
    std::thread::id there;
    const auto progress = [&](double done) {
        EXPECT_EQ(std::this_thread::get_id(), here);
        told.push_back(done);
        return true;
    };
    const bool is_done = run_job(progress, [&] {
        there = std::this_thread::get_id();
        expect_work(4);
        for (int i = 0; i < 4; ++i) {
            finish_work(1);
            std::this_thread::sleep_for(std::chrono::milliseconds(30));
            if (i == 1) expect_work(4);  // the fraction does not fall for it
        }
    });
    EXPECT_TRUE(is_done);
    EXPECT_NE(there, here);
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    EXPECT_EQ(told.front(), 0);
    EXPECT_EQ(told.back(), 1);
    EXPECT_NE(std::find(told.begin(), told.end(), 0.5), told.end());
}

TEST(RunJob, WithoutProgressIsAPartOfTheJobOfItsThread) {
    std::thread::id there;
    EXPECT_TRUE(run_job({}, [&] { there = std::this_thread::get_id(); }));
    EXPECT_EQ(there, std::this_thread::get_id());
    int told = 0;
    EXPECT_FALSE(run_job([&](double) { return ++told < 3; }, [] { run_job({}, endless); }));
}

TEST(RunJob, EndsSoonOnAllThreadsWhenProgressSaysSo) {
    int told = 0;
    EXPECT_FALSE(run_job([&](double) { return ++told < 3; }, endless));
    EXPECT_EQ(told, 3);
}

TEST(RunJob, EndsBeforeItBegins) {
    EXPECT_FALSE(run_job([](double) { return false; }, [] { FAIL() << "the work began"; }));
}

TEST(RunJob, ThrowsWhatProgressThrowsAndNotThatTheWorkWasStopped) {
    int told = 0;
    const auto progress = [&](double) {
        if (++told == 3) throw std::domain_error("of the host");
        return true;
    };
    EXPECT_THROW(run_job(progress, endless), std::domain_error);
    EXPECT_EQ(told, 3);
}

TEST(RunJob, ThrowsWhatTheWorkThrows) {
    const auto fails = [] {
        for_each_block(
            10, 2, [](std::size_t, std::size_t) { throw std::length_error("of the work"); }, {}, 1);
    };
    EXPECT_THROW(run_job([](double) { return true; }, fails), std::length_error);
    EXPECT_THROW(run_job({}, fails), std::length_error);
}

TEST(RunJob, LeavesOtherThreadsAlone) {
    EXPECT_EQ(Job::current(), nullptr);
    Job job;
    job.stop();
    {
        const Job::Scope scope(&job);
        EXPECT_THROW(stop_if_asked(), JobStopped);
        EXPECT_THROW(for_each_block(
                         4, 2, [](std::size_t, std::size_t) {}, {}, 1),
                     JobStopped);
    }
    stop_if_asked();
    EXPECT_EQ(Job::current(), nullptr);
}

}  // namespace
}  // namespace skinglow
