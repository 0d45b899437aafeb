// Fault bits of ticks in words, those of core/include/crankloop/faults.hpp by bit.

const kNames = ['not ready', 'speed', 'load ratio', 'pressure', 'phase jump', 'cam phase', 'event budget',
                'external torque', 'overspeed', 'trigger edges', 'gas', 'manifold', 'burn'];

export function faultWords(bits) {
  if (bits === 0) return 'none';
  const names = kNames.filter((_, bit) => Math.floor(bits / 2 ** bit) % 2 === 1);
  return names.length > 0 ? names.join(', ') : 'unknown';
}
