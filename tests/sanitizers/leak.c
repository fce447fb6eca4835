/* leak.c: loses a block of memory, so that a test sees the leak check find it. */
#include <stdlib.h>

int main(void) {
    void *volatile block = malloc(100);
    block = NULL;
    return block != NULL;
}
