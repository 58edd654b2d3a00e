from threadpoolctl import threadpool_info, threadpool_limits

from fem.threads import SMALL, suited_threads


def most_threads():
    return max((library["num_threads"] for library in threadpool_info()), default=1)


def test_small_systems_get_one_thread_and_large_ones_what_there_is():
    with threadpool_limits(2):
        before = most_threads()
        with suited_threads(SMALL - 1):
            assert most_threads() == 1
        with suited_threads(SMALL):
            assert most_threads() == before
        assert most_threads() == before
