/* OpenMP for Windows on one thread: what CoACD's library asks of Microsoft's vcomp140.dll, which neither
 * Windows nor Blender has. One thread does all of a loop, so there is nothing to share out. */

enum { MOST = 16 };

typedef void (*region)(void *, void *, void *, void *, void *, void *, void *, void *, void *, void *, void *,
                       void *, void *, void *, void *, void *);

__declspec(dllimport) int QueryPerformanceCounter(long long *);
__declspec(dllimport) int QueryPerformanceFrequency(long long *);

/* A parallel region with `count` variables of its surroundings, by their addresses. Whoever calls by
 * Windows' convention takes its own arguments away, so those that a region has not got do no harm. */
__declspec(dllexport) void _vcomp_fork(int is_parallel, int count, region body, ...)
{
    void *given[MOST] = {0};
    __builtin_va_list rest;
    (void)is_parallel;
    if (count > MOST)
        __builtin_trap();
    __builtin_va_start(rest, body);
    for (int number = 0; number < count; number++)
        given[number] = __builtin_va_arg(rest, void *);
    __builtin_va_end(rest);
    body(given[0], given[1], given[2], given[3], given[4], given[5], given[6], given[7], given[8], given[9],
         given[10], given[11], given[12], given[13], given[14], given[15]);
}

/* This thread's share of a loop, both ends included. */
__declspec(dllexport) void _vcomp_for_static_simple_init(unsigned first, unsigned last, int step, int is_rising,
                                                         unsigned *from, unsigned *to)
{
    (void)step;
    (void)is_rising;
    *from = first;
    *to = last;
}

__declspec(dllexport) void _vcomp_for_static_end(void) {}

/* Seconds since any time. */
__declspec(dllexport) double omp_get_wtime(void)
{
    long long now, each_second;
    QueryPerformanceCounter(&now);
    QueryPerformanceFrequency(&each_second);
    return (double)now / (double)each_second;
}

/* Called as this is loaded and left; refers to doubles, which a C library would answer for. */
int _fltused = 0;
int __stdcall DllMainCRTStartup(void *module, unsigned reason, void *reserved)
{
    (void)module;
    (void)reason;
    (void)reserved;
    return 1;
}
