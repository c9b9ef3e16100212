/** A store of this browser (IndexedDB), alone in its database: each request opens it, and fails where storage is forbidden. */
export type Ask = <T>(mode: IDBTransactionMode, act: (store: IDBObjectStore) => IDBRequest) => Promise<T>;

/** @param layout of what is kept there; what an older one holds is dropped */
export function storeOf(database: string, store: string, layout = 1): Ask {
  return <T>(mode: IDBTransactionMode, act: (store: IDBObjectStore) => IDBRequest) =>
    new Promise<T>((resolve, reject) => {
      const opening = indexedDB.open(database, layout);
      opening.onupgradeneeded = ({ oldVersion }) => {
        if (oldVersion > 0) {
          opening.result.deleteObjectStore(store);
        }
        opening.result.createObjectStore(store);
      };
      opening.onerror = () => reject(opening.error);
      opening.onsuccess = () => {
        const transaction = opening.result.transaction(store, mode);
        const acting = act(transaction.objectStore(store));
        const end = (settle: () => void) => () => {
          opening.result.close();
          settle();
        };
        transaction.oncomplete = end(() => resolve(acting.result as T));
        transaction.onabort = end(() => reject(transaction.error));
      };
    });
}
