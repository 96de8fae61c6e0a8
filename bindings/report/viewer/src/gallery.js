// A page of cards which lead to reports. list: [{title, text, page, image (data URL)}].
import { make } from './panel.js';

export function showGallery({ title, cards }) {
  document.title = title;
  const nodes = cards.map(({ title: name, text, page, image }) => {
    const card = make('a', { href: page });
    if (image) card.append(make('img', { src: image, alt: name }));
    card.append(make('div', {}, make('strong', {}, name), make('p', {}, text ?? '')));
    return card;
  });
  document.body.append(make('div', { className: 'gallery' }, make('h1', {}, title), make('div', { className: 'cards' }, ...nodes)));
}
