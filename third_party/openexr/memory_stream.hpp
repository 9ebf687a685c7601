/* SPDX-License-Identifier: Apache-2.0 */
/* memory_stream.hpp -- OpenEXR's streams over bytes in memory; private to exr_file.cpp. */
#pragma once
#include <OpenEXR/Iex.h>
#include <OpenEXR/ImfIO.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

class MemoryInput : public Imf::IStream {
public:
    MemoryInput(const char *name, const void *bytes, size_t size)
        : Imf::IStream(name), bytes_((const char *)bytes), size_(size)
    {
    }
    bool read(char *to, int n) override
    {
        if (n < 0 || at_ > size_ || (uint64_t)n > size_ - at_)
            throw Iex::InputExc("the file ends too early");
        memcpy(to, bytes_ + at_, (size_t)n);
        at_ += (uint64_t)n;
        return at_ < size_;
    }
    uint64_t tellg() override { return at_; }
    void     seekg(uint64_t position) override { at_ = position; }

private:
    const char *bytes_;
    uint64_t    size_, at_ = 0;
};

class MemoryOutput : public Imf::OStream {
public:
    explicit MemoryOutput(std::vector<char> *bytes, size_t most = 0)
        : Imf::OStream("memory"), bytes_(bytes)
    {
        bytes_->reserve(most); /* a vector that grows takes three times its bytes */
    }
    void write(const char *from, int n) override
    {
        if (at_ + (size_t)n > bytes_->size()) bytes_->resize(at_ + (size_t)n);
        std::copy_n(from, n, bytes_->begin() + (std::ptrdiff_t)at_);
        at_ += (size_t)n;
    }
    uint64_t tellp() override { return at_; }
    void     seekp(uint64_t position) override { at_ = (size_t)position; }

private:
    std::vector<char> *bytes_;
    size_t             at_ = 0;
};
