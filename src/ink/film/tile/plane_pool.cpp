#include <sys/mman.h>

#include <cstdlib>
#include <mutex>
#include <new>

#include "ink/canvas/canvas.h"
#include "ink/film/tile/film_tile.h"

// Planes, and the metric of tiles that get wet, come from blocks of 2 MiB, which the system may map as one page
// each: a film's step goes through twelve planes a tile, and looking up their pages takes longer than a tenth of
// its sums.
namespace tuft::ink {
namespace {

constexpr std::size_t kBlock = std::size_t{2} << 20;

struct Cell {
    Cell* next;
};
struct Block {
    Block *next = nullptr, *before = nullptr;  ///< among those with free planes
    Cell* free = nullptr;
    std::size_t used = 0, made = 0;  ///< cells given, and cells ever given: those beyond are untouched
};

/// Of cells of one size.
template <std::size_t kCell>
struct Pool {
    static constexpr std::size_t kCells = kBlock / kCell - 1;  // the first holds the block's head
    static_assert(sizeof(Block) <= kCell && kCell % 64 == 0);

    std::mutex mutex;
    Block* with_free = nullptr;

    void put_first(Block* b) {
        b->before = nullptr;
        b->next = with_free;
        if (with_free) with_free->before = b;
        with_free = b;
    }
    void take_out(Block* b) {
        (b->before ? b->before->next : with_free) = b->next;
        if (b->next) b->next->before = b->before;
    }
    void* take() {
        const std::lock_guard lock(mutex);
        if (!with_free) {
            void* memory = std::aligned_alloc(kBlock, kBlock);
            if (!memory) throw std::bad_alloc();
            ::madvise(memory, kBlock, MADV_HUGEPAGE);  // a hint: refused, pages are small
            put_first(new (memory) Block);
        }
        Block* b = with_free;
        void* cell = b->free;
        if (cell)
            b->free = b->free->next;
        else
            cell = reinterpret_cast<char*>(b) + kCell * ++b->made;
        if (++b->used == kCells) take_out(b);
        return cell;
    }
    void give(void* cell) {
        const std::lock_guard lock(mutex);
        auto* b = reinterpret_cast<Block*>(reinterpret_cast<std::uintptr_t>(cell) & ~(kBlock - 1));
        b->free = new (cell) Cell{b->free};
        if (b->used-- == kCells) put_first(b);
        if (b->used == 0 && (b->next || b->before)) {  // one block with free planes stays
            take_out(b);
            std::free(b);
        }
    }
};

template <class T>
auto& pool_of() {
    static auto* p = new Pool<sizeof(T)>;  // never destroyed: planes may outlive whatever is
    return *p;
}

template <class T>
void* take(std::size_t bytes) {
    if (bytes != sizeof(T)) return ::operator new (bytes, std::align_val_t{alignof(T)});
    return pool_of<T>().take();
}
template <class T>
void give(void* cell, std::size_t bytes) {
    if (!cell) return;
    if (bytes != sizeof(T))
        ::operator delete (cell, std::align_val_t{alignof(T)});
    else
        pool_of<T>().give(cell);
}

}  // namespace

void* Plane::operator new(std::size_t bytes) {
    return take<Plane>(bytes);
}
void Plane::operator delete(void* plane, std::size_t bytes) {
    give<Plane>(plane, bytes);
}

namespace wet {

void* Geometry::operator new(std::size_t bytes) {
    return take<Geometry>(bytes);
}
void Geometry::operator delete(void* geometry, std::size_t bytes) {
    give<Geometry>(geometry, bytes);
}
void* Geometry::Diagonals::operator new(std::size_t bytes) {
    return take<Diagonals>(bytes);
}
void Geometry::Diagonals::operator delete(void* diagonals, std::size_t bytes) {
    give<Diagonals>(diagonals, bytes);
}

}  // namespace wet
}  // namespace tuft::ink
