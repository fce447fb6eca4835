/* fake_ranks.h: where the test and its module find the sockets. Rank r > 0 speaks to rank 0 alone. */
#ifndef FAKE_RANKS_H
#define FAKE_RANKS_H

enum { FIRST_SOCKET = 500 };
#define SOCKET_OF_LEADER(rank) (FIRST_SOCKET + 2 * (int)(rank))
#define SOCKET_OF_RANK(rank) (FIRST_SOCKET + 2 * (int)(rank) + 1)

#endif
