/* What a library of units asks of bcryptprimitives.dll, which Wine has from version 9 on: random bytes. */

#define RtlGenRandom SystemFunction036
int __stdcall RtlGenRandom(void *bytes, unsigned long count);

__declspec(dllexport) int __stdcall ProcessPrng(unsigned char *bytes, unsigned long long count) {
    return RtlGenRandom(bytes, (unsigned long)count);
}
