// SPDX-License-Identifier: BSL-1.0
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <iostream>

namespace {
/// A case that was left out (`* doctest::skip(...)`) is named, so that it cannot be taken for a passed one.
struct name_the_skipped : doctest::IReporter {
    explicit name_the_skipped(const doctest::ContextOptions&) {}
    void test_case_skipped(const doctest::TestCaseData& test) override {
        if (test.m_skip) std::cout << "SKIPPED: " << test.m_name << '\n';
    }
    void report_query(const doctest::QueryData&) override {}
    void test_run_start() override {}
    void test_run_end(const doctest::TestRunStats&) override {}
    void test_case_start(const doctest::TestCaseData&) override {}
    void test_case_reenter(const doctest::TestCaseData&) override {}
    void test_case_end(const doctest::CurrentTestCaseStats&) override {}
    void test_case_exception(const doctest::TestCaseException&) override {}
    void subcase_start(const doctest::SubcaseSignature&) override {}
    void subcase_end() override {}
    void log_assert(const doctest::AssertData&) override {}
    void log_message(const doctest::MessageData&) override {}
};
REGISTER_LISTENER("name_the_skipped", 1, name_the_skipped);
} // namespace
